/** Blinding, on a real server: what a trainee's browser, the answers it gets, the server's log and the station's disk tell of an assignment that is not released. */
import { readdirSync, readFileSync, statSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { launch } from '../browser';
import { at, furnish, kScenarios, kTrainees, scored, tuned, type Programme } from '../programme';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus-server', 'tractus-station', 'tractus');
const [kAda] = kTrainees;

/** What would tell: names and ids of the scenarios, their kinds, the words that only a truth has. */
interface Telling {
  readonly what: string;
  readonly text: string;
}

function files(folder: string): string[] {
  return readdirSync(folder).flatMap((name) => {
    const path = join(folder, name);
    return statSync(path).isDirectory() ? files(path) : [path];
  });
}

const found = (telling: readonly Telling[], places: ReadonlyMap<string, string>) =>
  [...places].flatMap(([where, content]) =>
    telling.filter(({ text }) => content.includes(text)).map(({ what, text }) => `${where}: ${what}: ${text}`),
  );

describe.skipIf(bin === undefined)('an assignment whose results are held', () => {
  let browser: Browser, served: Served, programme: Programme, page: Page;
  let telling: Telling[] = [];
  let trials: string[] = [],
    assignment = '';
  const answers = new Map<string, string>();
  beforeAll(async () => {
    served = await serveReal(bin ?? '', ['--log-requests']);
    programme = await furnish(served, bin ?? '');
    const { admin, cohort } = programme;
    const { id } = await admin.ask<{ id: string }>('POST', '/assignments', {
      title: 'Twelve blind trials',
      cases: tuned,
      cohort,
      repeats: 3,
      ordering: 'random',
      seed: 5,
      release: 'held',
    });
    assignment = id;
    programme.does(kAda, 5);
    await scored(admin);
    const done = await admin.ask<{ trials: { trial_id: string }[] }>('GET', `/assignments/${id}`);
    trials = done.trials.map(({ trial_id }) => trial_id);
    const { cases } = await admin.ask<{ cases: { id: string; title: string }[] }>('GET', '/cases');
    const whole = await Promise.all(
      trials.map((one) =>
        admin.ask<{ case_id: string; case_title: string; scenario: { walls: unknown[] } | null }>(
          'GET',
          `/trials/${one}`,
        ),
      ),
    );
    telling = [
      ...whole.flatMap(({ case_id, case_title }) => [
        { what: 'id of a scenario', text: case_id },
        { what: 'name of a scenario', text: case_title },
      ]),
      ...kScenarios.filter((name) => name.includes('_')).map((text) => ({ what: 'kind of a scenario', text })),
      ...[
        '"walls"',
        '"layers"',
        '"breached"',
        '"breach_m"',
        '"breach_depth_m"',
        '"truth":{',
        'resistance_interval',
        'breach_interval',
      ].map((text) => ({ what: 'a word of the truth', text })),
      ...['"ordering"', '"seed":5'].map((text) => ({ what: 'the order', text })),
    ];
    expect(cases.length).toBeGreaterThan(0);
    browser = await launch();
    page = await at(browser, served, kAda, programme.passwords.get(kAda) ?? '');
    page.on('response', (response) => {
      if (!response.url().includes('/api/')) return;
      void response.text().then(
        (text) => answers.set(`${response.request().method()} ${new URL(response.url()).pathname}`, text),
        () => undefined,
      );
    });
  }, 300_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
  });

  it('has something to be blind to: the administrator is told what the trainee must not be', async () => {
    expect(trials).toHaveLength(5);
    const seen = JSON.stringify(await programme.admin.ask('GET', `/trials/${trials[0] ?? ''}`));
    expect(found(telling, new Map([['administrator', seen]])).length).toBeGreaterThan(2);
  });

  it('tells nothing through any route that a trainee may ask', async () => {
    const description = await programme.admin
      .ask<{ paths: Record<string, Record<string, { 'x-roles'?: string[] }>> }>('GET', '/../openapi.json')
      .catch(() => null);
    const paths = Object.entries(description?.paths ?? {}).flatMap(([path, methods]) => (methods.get ? [path] : []));
    expect(paths.length, 'the description names the routes').toBeGreaterThan(20);
    const { assignments } = await page.evaluate(
      async () => (await fetch('/api/v1/assignments')).json() as Promise<{ assignments: { id: string }[] }>,
    );
    const objects = [trials[0] ?? '', assignments[0]?.id ?? '', kAda, programme.cohort, telling[0]?.text ?? ''];
    const said = new Map<string, string>();
    let refused = 0;
    for (const path of paths) {
      if (path.includes('/live')) continue; // a socket, and not for trainees
      for (const object of path.includes('{') ? objects : ['']) {
        const filled = path.replaceAll(/\{[^}]+\}/g, encodeURIComponent(object));
        const [status, text] = await page.evaluate(async (address) => {
          const answer = await fetch(address);
          return [answer.status, await answer.text()] as const;
        }, filled);
        if (status === 200) said.set(`GET ${filled}`, text);
        else refused += 1;
      }
    }
    expect(said.size).toBeGreaterThan(3);
    expect(refused).toBeGreaterThan(20);
    said.delete('GET /api/openapi.json'); // the description of every route: names of fields, no content
    expect(found(telling, said)).toEqual([]);
  }, 120_000);

  it('leaves nothing in the pages, in what they keep, or in the browser’s caches', async () => {
    const seen = new Map<string, string>();
    answers.clear(); // what the test itself asked above
    for (const path of [
      '/',
      '/cases',
      '/trials',
      '/me',
      '/assignments',
      `/assignments/${assignment}`,
      '/guide/trainee',
      '/account',
      ...trials.map((one) => `/trials/${one}`),
      `/trainees/${encodeURIComponent(kAda)}`,
      '/studies',
      '/lab',
      '/wall',
    ]) {
      await page.goto(path);
      await page.waitForLoadState('networkidle');
      seen.set(`page ${path}`, await page.content());
    }
    seen.set(
      'storage',
      await page.evaluate(async () =>
        JSON.stringify({
          local: { ...localStorage },
          session: { ...sessionStorage },
          databases: (await indexedDB.databases()).map(({ name }) => name),
          cookie: document.cookie,
          history: window.history.state as unknown,
        }),
      ),
    );
    seen.set(
      'caches',
      await page.evaluate(async () => {
        const kept: string[] = [];
        for (const name of await caches.keys())
          for (const request of await (await caches.open(name)).keys()) kept.push(request.url);
        return kept.join('\n');
      }),
    );
    expect(found(telling, seen)).toEqual([]);
    expect(answers.size).toBeGreaterThan(3);
    expect(found(telling, answers)).toEqual([]);
    const uncached = await page.evaluate(async () => (await fetch('/api/v1/trials')).headers.get('cache-control'));
    expect(uncached).toContain('no-store');
  }, 120_000);

  it('leaves nothing in the server’s log', () => {
    const log = readFileSync(served.log, 'utf8');
    expect(log.length).toBeGreaterThan(500);
    expect(found(telling, new Map([['log', log]]))).toEqual([]);
  });

  it('leaves nothing on the station’s disk', () => {
    const kept = new Map(
      files(programme.station.folder).map((path) => [path, `${path}\n${readFileSync(path, 'latin1')}`]),
    );
    expect([...kept.keys()].filter((path) => path.endsWith('.ttrial'))).toHaveLength(5);
    expect(found(telling, kept)).toEqual([]);
  });
});
