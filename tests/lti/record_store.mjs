// A learning record store (xAPI 1.0.3) for the tests: npm's @learninglocker/xapi-statements, the service of Learning Locker, with its
// models and files in memory. Listens on a free port and prints its endpoint; then reads lines from standard input: "away" and "back"
// (it answers 500 to everything meanwhile), "statements"; each is answered with a line, the last with the statements it keeps, as JSON.
// It validates every statement, refuses other credentials than key:secret, and takes a statement of a known id once.
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import {createInterface} from 'node:readline';
import {mkdtempSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

// Standard output is for answers alone; what the libraries have to say goes beside it.
const answer = (line) => process.stdout.write(`${line}\n`);
console.log = console.info = console.warn = console.error;
process.env.WINSTON_CONSOLE_LEVEL = 'error';
process.chdir(mkdtempSync(join(tmpdir(), 'record-store-')));
const require = createRequire(import.meta.url);
const part = (name) => require(`@learninglocker/xapi-statements/dist/${name}`).default;
const express = require('express');

const rights = {
  _id: 'client',
  title: 'tests',
  isTrusted: true,
  lrs_id: 'store',
  organisation: 'organisation',
  scopes: ['all'],
  authority: {
    objectType: 'Agent',
    account: {homePage: 'https://store.example.org', name: 'tests'},
  },
};
const expected = `Basic ${Buffer.from('key:secret').toString('base64')}`;

const app = express();
let away = false;
app.use((_request, response, next) => (away ? response.status(500).end() : next()));
app.get('/rights', (request, response) =>
  request.headers.authorization === expected ? response.json(rights) : response.status(404).end(),
);
const server = createServer(app).listen(0, '127.0.0.1', () => {
  const base = `http://127.0.0.1:${server.address().port}`;
  const logger = part('logger'),
    tracker = part('tracker');
  const repo = part('repo/factory')({
    auth: {
      facade: 'fetch',
      fetch: {llClientInfoEndpoint: `${base}/rights`},
    },
    events: {facade: 'test'},
    models: {
      facade: 'memory',
      memory: {state: {fullActivities: [], statements: []}},
    },
    storage: {facade: 'local', local: {storageDir: process.cwd()}},
  });
  const settings = part('config');
  const service = part('service')({
    ...settings.service,
    repo,
    tracker,
    logger,
  });
  const presenter = part('expressPresenter')({
    ...settings.express,
    llClientInfoEndpoint: `${base}/rights`,
    service,
    tracker,
    logger,
    translator: part('translatorFactory')(),
    morganDirectory: process.cwd(),
  });
  app.use('/xAPI/statements', presenter.statementsRouter);
  const lines = createInterface({input: process.stdin});
  lines.on('line', async (line) => {
    if (line !== 'statements') {
      away = line === 'away';
      answer('ready');
      return;
    }
    const kept = await fetch(`${base}/xAPI/statements`, {
      headers: {authorization: expected, 'x-experience-api-version': '1.0.3'},
    });
    answer(JSON.stringify((await kept.json()).statements));
  });
  lines.on('close', () => process.exit(0));
  answer(`${base}/xAPI`);
});
