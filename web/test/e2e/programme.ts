/** A small programme on a real server, made as it is made in practice: accounts, a cohort, assignments, SIMULATED hands at a station. */
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Browser, Page } from 'playwright-core';
import type { Served } from './real-server';
import { Words } from './words';

const kRoot = fileURLToPath(new URL('../../..', import.meta.url));
const kPin = '2580',
  kTrials_ms = 240_000;
export const kTrainees = ['Simulated Ada', 'Simulated Ben'] as const;
export const kScenarios = ['hard', 'soft', 'lateral_breach', 'in_out_in'] as const;

type Json = Record<string, unknown>;

/** Somebody who has signed in, without a browser. */
export class Person {
  private cookie = '';
  constructor(private readonly url: string) {}

  async in(name: string, password: string): Promise<this> {
    await this.ask('POST', '/session', { name, password });
    return this;
  }

  async ask<Answer = Json>(method: string, path: string, body?: unknown): Promise<Answer> {
    const raw = body instanceof Uint8Array;
    const answer = await fetch(`${this.url}/api/v1${path}`, {
      method,
      headers: {
        'X-Tractus': '1',
        Cookie: this.cookie,
        ...(body === undefined ? {} : { 'Content-Type': raw ? 'application/octet-stream' : 'application/json' }),
      },
      ...(body === undefined ? {} : { body: raw ? (body as Uint8Array<ArrayBuffer>) : JSON.stringify(body) }),
    });
    const set = answer.headers.get('set-cookie');
    if (set) this.cookie = set.split(';')[0] ?? '';
    const text = await answer.text();
    if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${text}`);
    return (text === '' ? {} : JSON.parse(text)) as Answer;
  }
}

export interface Programme {
  readonly admin: Person;
  readonly passwords: ReadonlyMap<string, string>;
  readonly cohort: string;
  readonly station: { readonly folder: string; readonly token: string; readonly id: string };
  /** Does what is assigned: a simulated hand at the station, in simulated time. */
  readonly does: (trainee: (typeof kTrainees)[number], trials: number, device?: string) => void;
  readonly station_does: (...words: string[]) => string;
}

/** One account of each role, two trainees in a cohort of the faculty's, a station that may bring trials, a palpation case with a medial breach. */
export async function furnish(served: Served, bin: string): Promise<Programme> {
  const admin = await new Person(served.url).in(served.account.name, served.account.password);
  const passwords = new Map<string, string>();
  const account = async (name: string, role: string, badge?: string) => {
    const { password: first } = await admin.ask<{ password: string }>('POST', '/accounts', {
      name,
      role,
      ...(badge ? { badge, pin: kPin } : {}),
    });
    const password = `the password of ${name}`;
    await (
      await new Person(served.url).in(name, first)
    ).ask('POST', '/session/password', { old: first, new: password });
    passwords.set(name, password);
  };
  for (const role of ['director', 'faculty', 'researcher', 'technician']) await account(role, role);
  const { id: cohort } = await admin.ask<{ id: string }>('POST', '/cohorts', { name: 'Residents (simulated)' });
  await admin.ask('POST', `/cohorts/${cohort}/people`, { name: 'faculty' });
  for (const [i, name] of kTrainees.entries()) {
    await account(name, 'trainee', String(100 + i));
    await admin.ask('POST', `/cohorts/${cohort}/people`, { name });
  }

  const run = (program: string, ...words: string[]) =>
    execFileSync(join(bin, program), words, {
      encoding: 'utf8',
      timeout: kTrials_ms,
      stdio: ['ignore', 'pipe', 'pipe'],
    });
  const folder = join(served.folder, 'station'),
    token = join(served.folder, 'station.token'),
    pin = join(served.folder, 'pin');
  mkdirSync(folder);
  writeFileSync(pin, `${kPin}\n`);
  writeFileSync(join(folder, 'config.json'), JSON.stringify({ format: 'tractus-station/1', name: 'skills lab' }));
  const { code } = await admin.ask<{ code: string }>('POST', '/stations/codes', { name: 'skills lab' });
  run('tractus-station', 'enrol', '--server', served.url, '--code', code, '--token-file', token);
  const { stations } = await admin.ask<{ stations: { id: string }[] }>('GET', '/stations');

  const volume = join(served.folder, 'l3.tvol'),
    made = join(served.folder, 'case'),
    key = join(served.folder, 'signing.key');
  run('tractus', 'import', join(kRoot, 'tests/data/ct/tptbox_L3/sub-ct_label-22_ct.nii.gz'), volume);
  run(
    'tractus',
    'carve',
    '--volume',
    volume,
    '--entry',
    '46,200,-61',
    '--target',
    '38.5,158,-61',
    '--breach',
    'medial',
    '--title',
    'L3 left pedicle',
    '--source',
    'TPTBox sample CT',
    '--key',
    key,
    '--out',
    made,
  );
  run('tractus-server', 'publish', '--data', join(served.folder, 'data'), made);
  run('tractus-station', 'trust', '--data', folder, '--case', made);

  const at = ['--data', folder, '--server', served.url, '--token-file', token];
  return {
    admin,
    passwords,
    cohort,
    station: { folder, token, id: stations[0]?.id ?? '' },
    does: (trainee, trials, device = 'sim-rig') => {
      run(
        'tractus-station',
        'assigned',
        '--badge',
        String(100 + kTrainees.indexOf(trainee)),
        '--pin-file',
        pin,
        ...at,
        '--device',
        device,
        '--speed',
        'fast',
        '--duration',
        '6',
        '--seed',
        '7',
        '--trials',
        String(trials),
        '--json',
      );
    },
    station_does: (...words) => run('tractus-station', ...words, ...at),
  };
}

export const tuned = kScenarios.map((name) => ({ scenario: { tuned: name } }));

/** Until every trial has its scores. */
export async function scored(admin: Person): Promise<void> {
  for (let i = 0; i < 300; ++i) {
    const { trials } = await admin.ask<{ trials: { state: string }[] }>('GET', '/trials?limit=200');
    if (trials.every(({ state }) => state !== 'assessing')) return;
    await new Promise((resolve) => setTimeout(resolve, 200));
  }
  throw new Error('the server has not scored every trial after a minute');
}

/** A fresh browser of somebody's, signed in through the page. */
export async function at(
  browser: Browser,
  served: Served,
  name: string,
  password: string,
  { dark = false, words = new Words('en') }: { readonly dark?: boolean; readonly words?: Words } = {},
): Promise<Page> {
  const context = await browser.newContext({
    viewport: { width: 1440, height: 900 },
    baseURL: served.url,
    locale: words.locale,
    colorScheme: dark ? 'dark' : 'light',
  });
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  await page.goto('/');
  await page.getByLabel(words.said('Name')).fill(name);
  await page.getByLabel(words.said('Password')).fill(password);
  await page.getByRole('button', { name: words.said('Sign in') }).click();
  await page.getByRole('button', { name: words.said('Sign out') }).waitFor();
  return page;
}
