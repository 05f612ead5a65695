/** Every page of every manifest on a real server with a small programme: not wider than the window, no fault by axe-core; the first paint is printed. */
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { launch, signIn, visit } from '../browser';
import { kWidths_px, measured, scriptsOf, type Measured } from '../measured';
import { at, furnish, kTrainees, scored, tuned, type Programme } from '../programme';
import { programs, serveReal, type Served } from '../real-server';
import { addressesOf, everyRoute } from '../routes';

const bin = programs('tractus-server', 'tractus-station', 'tractus');
const kCt = fileURLToPath(new URL('../../../../tests/data/ct/tptbox_L3/sub-ct_label-22_ct.nii.gz', import.meta.url));
const [kAda] = kTrainees;
const kScripts_B = 100_000;
/** Pages of a trainee's own; an administrator has none. */
const kOwn: readonly string[] = ['/me', '/curriculum'];
/** The work page of the model lab is measured on the recorded set of the simulated server. */
const kRecorded: readonly string[] = ['/lab/work/:model/:set/:step?'];
const kSteps = ['compare', 'where', 'missing', 'add', 'publish'];
const kRoles = ['admin', 'director', 'faculty', 'researcher', 'technician', 'trainee', 'first-week', 'scripts'];

type Known = Record<string, readonly string[]>;

/** One object of each kind, made through the API as the pages make it. */
async function furnished({ admin, cohort, does, station }: Programme, ct: Uint8Array): Promise<Known> {
  const post = <Answer = { id: string }>(path: string, body: unknown) => admin.ask<Answer>('POST', path, body);
  const assignment = await post('/assignments', { title: 'Four kinds of bone', cases: tuned, cohort, repeats: 1 });
  does(kAda, 4);
  const { cases } = await admin.ask<{ cases: { id: string; title: string }[] }>('GET', '/cases');
  const l3 = cases.find(({ title }) => title === 'L3 left pedicle')?.id ?? '';
  await post('/assignments', { title: 'The wall of the tract', cases: [{ case: l3 }], people: [kAda] });
  does(kAda, 1, 'sim-lambda6');
  await scored(admin);
  await post('/consents', { account: kAda, tier: 'metrics', basis: 'simulated: no person' });
  const volume = await post('/volumes?name=L3&source=TPTBox%20L3,%20Apache-2.0', ct);
  await post(`/volumes/${volume.id}/release`, { looked_at: true });
  const study = await post('/studies', {
    id: 'twelve',
    title: 'Twelve trials',
    scenarios: [{ tuned: 'hard' }, { tuned: 'soft' }],
    repeats: 2,
    participants: [{ name: 'P01', simulated: true }],
  });
  const rubric = {
    format: 'tractus-rubric/1',
    title: 'Global rating',
    items: [{ label: 'Respect for tissue', low_text: 'rough', high_text: 'careful' }],
  };
  await post('/rubrics', { id: 'global', rubric });
  const requirements = [{ kind: 'recognition', share: 0.01, level: 0.95 }];
  const criteria = { format: 'tractus-criteria/1', requirements };
  const curricula = await post<{ curricula: { id: string }[] }>('/curricula', {
    title: 'Pedicle screws',
    steps: [{ id: 'a', name: 'Hard bone', cases: [{ scenario: { tuned: 'hard' } }], repeats: 2, after: [], criteria }],
  });
  const curriculum = curricula.curricula[0]?.id ?? '';
  await post(`/curricula/${curriculum}/cohorts`, { cohort, release: 'at_once' });
  const run = await post('/cohort/analyses', { method: 'describe', formula: 'probing_time ~ 1' });
  const { trials } = await admin.ask<{ trials: { id: string; case_title: string }[] }>('GET', '/trials?limit=50');
  const { accounts } = await admin.ask<{ accounts: { id: string; name: string }[] }>('GET', '/accounts');
  const ada = accounts.find(({ name }) => name === kAda)?.id ?? '';
  await post(`/trials/${trials[0]?.id ?? ''}/rating-requests`, { rubric: 'global', raters: 1 });
  return {
    '/analysis/runs/:id': [`/analysis/runs/${run.id}`],
    '/assignments/:id': [`/assignments/${assignment.id}`],
    '/cases/:id': [`/cases/${l3}`],
    '/cases/new/:volume': [`/cases/new/${volume.id}`],
    '/certificates/:account/:curriculum': [`/certificates/${ada}/${curriculum}`],
    '/criteria/:kind/:id': [`/criteria/case/${l3}`, `/criteria/assignment/${assignment.id}`],
    '/curricula/:id': [`/curricula/${curriculum}`],
    '/curricula/:id/edit': [`/curricula/${curriculum}/edit`],
    '/guide/:role?': ['/guide', ...kRoles.map((role) => `/guide/${role}`)],
    '/network/people/:id/leaving': [`/network/people/${ada}/leaving`],
    '/network/stations/:id': [`/network/stations/${station.id}`],
    '/ratings/rubrics/:id': ['/ratings/rubrics/global'],
    '/scenarios/:id': ['/scenarios/lateral_breach'],
    '/studies/:id': [`/studies/${study.id}`],
    '/trainees/:name': [`/trainees/${encodeURIComponent(kAda)}`],
    '/trials/:id': trials.slice(0, 2).map(({ id }) => `/trials/${id}`),
    '/trials/:id/debrief': trials.slice(0, 2).map(({ id }) => `/trials/${id}/debrief`),
    '/volumes/:id': [`/volumes/${volume.id}`],
  };
}

/** A locked plan is made on its page, which knows what a plan has. */
async function lockedPlan(page: Page): Promise<string> {
  await page.goto('/analysis/plans/new');
  await page.getByLabel('Title').fill('Does practice shorten the operation?');
  await page.getByLabel('Endpoint').first().selectOption('operation_time');
  await page.getByRole('button', { name: 'Add to plan' }).click();
  await page.getByRole('button', { name: 'Lock plan…' }).click();
  await page.getByRole('button', { name: 'Lock plan', exact: true }).click();
  await page.waitForURL(/\/analysis\/plans\/(?!new)/);
  return new URL(page.url()).pathname;
}

/** Addresses of the lab's steps on the recorded set. */
async function recordedSteps(page: Page): Promise<string[]> {
  await signIn(page, '/lab');
  await page.getByRole('button', { name: 'Compare' }).click();
  await page.locator('[data-panel="value"] canvas').waitFor();
  const [, lab, work, model, set] = new URL(page.url()).pathname.split('/');
  return kSteps.map((step) => `/${[lab, work, model, set, step].join('/')}`);
}

describe.skipIf(bin === undefined || !inject('fixture'))('the pages', () => {
  let browser: Browser, served: Served, programme: Programme, admin: Page, trainee: Page, recorded: Page, known: Known;
  const all: Measured[] = [];

  beforeAll(async () => {
    browser = await launch();
    served = await serveReal(bin ?? '');
    programme = await furnish(served, bin ?? '');
    known = await furnished(programme, new Uint8Array(readFileSync(kCt)));
    admin = await at(browser, served, served.account.name, served.account.password);
    trainee = await at(browser, served, kAda, programme.passwords.get(kAda) ?? '');
    ({ page: recorded } = await visit(browser));
    known['/lab/work/:model/:set/:step?'] = await recordedSteps(recorded);
    known['/analysis/plans/:id'] = [await lockedPlan(admin)];
  }, 300_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
  });

  it('send the scripts of a first visit packed, within 100 kB', async () => {
    const page = await browser.newPage();
    const scripts = await scriptsOf(page, served.url);
    const whole_B = scripts.reduce((sum, { wire_B }) => sum + wire_B, 0);
    console.log(`scripts of the first visit: ${String(whole_B)} bytes`, scripts);
    expect(scripts.filter(({ coding, wire_B }) => coding === '' && wire_B > 1024)).toEqual([]);
    expect(scripts.some(({ coding }) => coding !== '')).toBe(true);
    expect(whole_B).toBeLessThanOrEqual(kScripts_B);
    await page.close();
  }, 60_000);

  it.each(everyRoute())(
    '%s',
    async (pattern) => {
      const page = kOwn.includes(pattern) ? trainee : kRecorded.includes(pattern) ? recorded : admin;
      const addresses = addressesOf(pattern, known);
      expect(addresses, 'an address to measure').not.toEqual([]);
      for (const address of addresses) {
        const found = await measured(page, address);
        all.push(found);
        expect(found.faults).toEqual([]);
      }
    },
    120_000,
  );

  it('are all measured', () => {
    const slowest = [...all].sort((a, b) => b.firstPaint_ms - a.firstPaint_ms);
    console.log(
      `${String(all.length)} addresses of ${String(everyRoute().length)} routes at ${kWidths_px.join(', ')} px; first paint, ms: slowest ${slowest
        .slice(0, 3)
        .map(({ address, firstPaint_ms }) => `${address} ${firstPaint_ms.toFixed(0)}`)
        .join(', ')}; median ${slowest[Math.floor(slowest.length / 2)]?.firstPaint_ms.toFixed(0) ?? ''}`,
    );
    expect(all.length).toBeGreaterThanOrEqual(everyRoute().length);
  });
});
