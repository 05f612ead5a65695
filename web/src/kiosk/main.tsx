import { StrictMode } from 'react';
import { createRoot } from 'react-dom/client';
import { preferredLanguage, speak } from '@/language';
import '@/ui/tokens.css';
import '@/ui/base.css';
import { Kiosk } from './kiosk';

const root = document.getElementById('root');
if (!root) throw new Error('kiosk.html has no #root');
// The catalogue comes from the station itself; without it the page is in English.
await speak(preferredLanguage()).catch(() => undefined);
createRoot(root).render(
  <StrictMode>
    <Kiosk />
  </StrictMode>,
);
