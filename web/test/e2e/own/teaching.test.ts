/**
 * Faculty and trainee, from the volume to the comment, on a real server with a real station process: a palpation case with a medial breach
 * is made, assigned, done at a station by a simulated hand, talked through, released and seen.
 */
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { accessibilityFaults } from '../axe';
import { kShots, launch } from '../browser';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus-server', 'tractus-station');
const kCt = fileURLToPath(new URL('../../../../tests/data/ct/tptbox_L3/sub-ct_label-22_ct.nii.gz', import.meta.url));
/** The left pedicle of that vertebra, in mm of the patient. */
const kEntry = ['46', '200', '-61'],
  kTarget = ['38.5', '158', '-61'];
const kBadge = '4711',
  kPin = '246810',
  kComment = 'Here the wall gives way: stop pushing as soon as it does.';
const kPasswords = { faculty: 'faculty of the tests', trainee: 'trainee of the tests' };

/** The API as somebody signed in, without a browser: for what others than the two have prepared. */
class Caller {
  private cookie = '';
  constructor(private readonly url: string) {}
  async call<Answer>(method: string, path: string, body?: unknown): Promise<Answer> {
    const raw = body instanceof Uint8Array;
    const response = await fetch(`${this.url}/api/v1${path}`, {
      method,
      headers: {
        'X-Tractus': '1',
        Cookie: this.cookie,
        ...(body === undefined ? {} : { 'Content-Type': raw ? 'application/octet-stream' : 'application/json' }),
      },
      ...(body === undefined ? {} : { body: raw ? new Uint8Array(body) : JSON.stringify(body) }),
    });
    const text = await response.text();
    if (!response.ok) throw new Error(`${method} ${path}: ${response.status} ${text}`);
    this.cookie = response.headers.get('set-cookie')?.split(';')[0] ?? this.cookie;
    return (text === '' ? {} : JSON.parse(text)) as Answer;
  }
  signIn(name: string, password: string) {
    return this.call('POST', '/session', { name, password });
  }
}

/** An account whose first password was changed already. */
async function person(
  admin: Caller,
  url: string,
  name: string,
  role: 'faculty' | 'trainee',
  more: object = {},
): Promise<void> {
  const { password } = await admin.call<{ password: string }>('POST', '/accounts', { name, role, ...more });
  const own = new Caller(url);
  await own.signIn(name, password);
  await own.call('POST', '/session/password', { old: password, new: kPasswords[role] });
}

describe.skipIf(bin === undefined)('a palpation case with a medial breach', () => {
  let browser: Browser, served: Served, faculty: Page, trainee: Page, token: string;

  const station = (...words: string[]) => execFileSync(join(bin ?? '', 'tractus-station'), words, { encoding: 'utf8' });
  const shot = async (page: Page, name: string) => {
    await page.screenshot({ path: `${kShots}journey-${name}.png`, fullPage: true });
    expect(await accessibilityFaults(page), name).toEqual([]);
  };
  async function signedIn(name: string, password: string): Promise<Page> {
    const context = await browser.newContext({ viewport: { width: 1440, height: 900 }, baseURL: served.url });
    const page = await context.newPage();
    page.setDefaultTimeout(60_000);
    await page.goto('/');
    await page.getByLabel('Name').fill(name);
    await page.getByLabel('Password').fill(password);
    await page.getByRole('button', { name: 'Sign in' }).click();
    await page.getByRole('button', { name: 'Sign out' }).waitFor();
    return page;
  }

  beforeAll(async () => {
    served = await serveReal(bin ?? '');
    const admin = new Caller(served.url);
    await admin.signIn(served.account.name, served.account.password);
    await person(admin, served.url, 'F. Senior', 'faculty');
    await person(admin, served.url, 'A. Resident', 'trainee', { badge: kBadge, pin: kPin });
    const { id: cohort } = await admin.call<{ id: string }>('POST', '/cohorts', { name: 'Residents 2027' });
    for (const name of ['F. Senior', 'A. Resident']) await admin.call('POST', `/cohorts/${cohort}/people`, { name });
    const { id: volume } = await admin.call<{ id: string }>(
      'POST',
      '/volumes?name=L3&source=TPTBox%20L3,%20Apache-2.0',
      new Uint8Array(readFileSync(kCt)),
    );
    await admin.call('POST', `/volumes/${volume}/release`, { looked_at: true });
    const { code } = await admin.call<{ code: string }>('POST', '/stations/codes', { name: 'skills lab 1' });
    token = join(served.folder, 'station.token');
    station(
      'enrol',
      '--server',
      served.url,
      '--code',
      code,
      '--token-file',
      token,
      '--data',
      join(served.folder, 'station'),
    );
    writeFileSync(join(served.folder, 'pin'), `${kPin}\n`);
    browser = await launch();
    faculty = await signedIn('F. Senior', kPasswords.faculty);
    trainee = await signedIn('A. Resident', kPasswords.trainee);
  }, 240_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
  });

  /** Turned to medial, the picture of a plan moved by half a millimetre is seen from medial too. */
  async function staysWhereOneLooks() {
    const anterior = async () => {
      const box = await faculty.locator('[data-part="scene"] span', { hasText: 'Anterior' }).boundingBox();
      return { x: box?.x ?? NaN, y: box?.y ?? NaN };
    };
    const apart = (a: { x: number; y: number }, b: { x: number; y: number }) => Math.hypot(a.x - b.x, a.y - b.y);
    const first = await anterior();
    await faculty.getByRole('button', { name: 'Look from medial' }).click();
    await faculty.waitForTimeout(300);
    const turned = await anterior();
    expect(apart(first, turned)).toBeGreaterThan(40);
    const drawn = await faculty.locator('[data-part="scene"] canvas').elementHandle();
    await faculty.locator('[data-end="target"] input[type="number"]').nth(2).fill('-60.5');
    await faculty.waitForFunction(
      (canvas) => canvas && !canvas.isConnected && document.querySelector('[data-part="scene"][data-ready] canvas'),
      drawn,
    );
    await faculty.waitForTimeout(300);
    expect(apart(turned, await anterior())).toBeLessThan(15);
  }

  it('is made of a released volume, with the wall’s thickness told before', async () => {
    await faculty.getByRole('link', { name: 'Cases', exact: true }).click();
    await faculty.getByRole('link', { name: 'L3', exact: true }).click();
    await faculty.locator('[data-plane="axial"][data-ready]').waitFor();
    for (const [end, at] of [
      ['entry', kEntry],
      ['target', kTarget],
    ] as const) {
      const fields = faculty.locator(`[data-end="${end}"] input[type="number"]`);
      for (const [i, value] of at.entries()) await fields.nth(i).fill(value);
    }
    await faculty.getByLabel('Breach', { exact: true }).selectOption('medial');
    const said = faculty.locator('[data-part="breach"]');
    await said.waitFor();
    expect(await said.innerText()).toMatch(/^The medial wall is breached at a depth of \d/);
    await faculty.locator('[data-part="scene"][data-ready]').waitFor();
    await faculty.waitForLoadState('networkidle');
    await faculty.waitForTimeout(1000);
    await shot(faculty, '1-plan');
    await staysWhereOneLooks();
    await faculty.getByLabel('Title (not shown to trainees)').fill('L3 left, medial breach');
    await faculty.getByRole('button', { name: 'Create case' }).click();
    await faculty.getByRole('link', { name: 'L3 left, medial breach' }).waitFor({ timeout: 120_000 });
    await shot(faculty, '2-made');
  }, 240_000);

  it('is assigned to a cohort under a blind name', async () => {
    await faculty.getByRole('link', { name: 'Assign cases' }).click();
    await faculty.getByRole('checkbox', { name: 'L3 left, medial breach' }).check();
    await faculty.getByLabel('Cohort (includes later members)').selectOption({ index: 1 });
    await faculty.getByLabel('Title, shown to trainees').fill('Week 12');
    await shot(faculty, '3-assign');
    await faculty.getByRole('button', { name: 'Assign', exact: true }).click();
    await faculty.getByRole('heading', { name: 'Week 12' }).waitFor();
    expect(await faculty.locator('body').innerText()).toContain('0 of 1');
    await trainee.reload();
    await trainee.getByRole('link', { name: 'Week 12' }).waitFor();
    expect(await trainee.content()).not.toMatch(/medial|L3/);
    await shot(trainee, '4-due');
  }, 120_000);

  it('is done at a station that was never told where the breach is', () => {
    const data = join(served.folder, 'station');
    const out = station(
      'assigned',
      '--data',
      data,
      '--server',
      served.url,
      '--token-file',
      token,
      '--badge',
      kBadge,
      '--pin-file',
      join(served.folder, 'pin'),
      '--device',
      'sim-lambda6',
      '--seed',
      '3',
      '--duration',
      '8',
      '--speed',
      'fast',
      '--answer',
      'medial',
    );
    expect(out).not.toMatch(/L3 left/);
    station('upload', '--data', data, '--server', served.url, '--token-file', token, '--wait', '30');
  }, 240_000);

  it('is seen done, talked through and released', async () => {
    await faculty.getByText('1 of 1').first().waitFor();
    await faculty.getByText('correct', { exact: true }).waitFor({ timeout: 60_000 });
    await shot(faculty, '5-done');
    await faculty.getByRole('link', { name: /^Debrief/ }).click();
    await faculty.locator('[data-part="scene"][data-ready]').waitFor();
    await faculty.getByRole('button', { name: 'Play' }).click();
    await faculty.waitForTimeout(700);
    await faculty.getByRole('button', { name: 'Pause' }).click();
    const moment = Number(await faculty.getByLabel('Time in the trial').inputValue());
    expect(moment).toBeGreaterThan(0.2);
    await faculty.getByLabel('Comment', { exact: true }).fill(kComment);
    await faculty.getByRole('button', { name: 'Add comment' }).click();
    await faculty.getByText(kComment).waitFor();
    await faculty.getByRole('button', { name: 'Release results' }).click();
    await faculty.getByText('Trainees can see the results and comments of this assignment.').waitFor();
    await shot(faculty, '6-debrief');
  }, 120_000);

  it('is seen by its trainee with the result and the comment', async () => {
    await trainee.goto('/assignments');
    await trainee.getByRole('link', { name: 'Week 12' }).click();
    await trainee.getByText('correct', { exact: true }).waitFor();
    await shot(trainee, '7-result');
    await trainee.getByRole('link', { name: /^Debrief/ }).click();
    await trainee.getByText(kComment).waitFor();
    await trainee.locator('[data-part="scene"][data-ready]').waitFor();
    await shot(trainee, '8-comment');
    expect(await trainee.getByRole('button', { name: 'Release results' }).count()).toBe(0);
  }, 120_000);
});
