import { StrictMode } from 'react';
import { createRoot } from 'react-dom/client';
import { sessionQuery } from './api';
import { App, makeClient } from './app';
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
// The menu depends on who is signed in: the first picture waits for that, or it would jump. Not for long.
const kPatience_ms = 700;
void Promise.race([
  client.prefetchQuery(sessionQuery),
  new Promise((done) => {
    setTimeout(done, kPatience_ms);
  }),
]).then(show, show);
