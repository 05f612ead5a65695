import { StrictMode } from 'react';
import { createRoot } from 'react-dom/client';
import { sessionQuery } from './api';
import { App, makeClient } from './app';
import { sessionLanguage } from './features/session';
import { preferredLanguage, speak } from './language';
import './ui/tokens.css';
import './ui/base.css';

const root = document.getElementById('root');
if (!root) throw new Error('index.html has no #root');
const client = makeClient();
const show = () =>
  createRoot(root).render(
    <StrictMode>
      <App client={client} />
    </StrictMode>,
  );
// The menu depends on who is signed in, its words on the language: the first picture waits for both, or it would jump.
// Not for long; a catalogue that comes later changes the page then, one that does not come leaves it in English.
const kPatience_ms = 700;
void Promise.race([
  Promise.all([
    client.prefetchQuery(sessionQuery).then(() => speak(sessionLanguage(client))),
    speak(preferredLanguage()), // who is signed in reads it most of the time: it comes beside the session
  ]).catch(() => undefined),
  new Promise((done) => {
    setTimeout(done, kPatience_ms);
  }),
]).then(show, show);
