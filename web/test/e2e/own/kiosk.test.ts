/**
 * The kiosk, driven on its screen against a real server by a person with both simulated rigs: sign-in, trials, answers, results; and what
 * goes wrong: a wrong PIN, a cut network, a killed station, an emergency stop, a dead rig. What was promised arrives at the server.
 */
import { existsSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { accessibilityFaults } from '../axe';
import { kShots, launch } from '../browser';
import {
  kResetButton,
  kStartButton,
  kStopButton,
  Line,
  startKiosk,
  startRig,
  shown,
  type Kiosk,
} from '../kiosk-station';
import { furnish, type Programme } from '../programme';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus', 'tractus-server', 'tractus-station', 'tractus-rig') ?? '';
const kAda = '100',
  kBen = '101',
  kPin = '2580';
const kTrial_ms = 60_000,
  kPause_s = 3;

interface Answered {
  readonly duration_s: number;
  readonly events: readonly { kind: string; detail: { lasted_s?: number } }[];
  readonly answer: { wall: string | null; breach: boolean; confidence: number; depth_m: number | null } | null;
}
interface Assigned {
  readonly done: number;
  readonly trials: { trial_id: string }[];
}

describe.skipIf(bin === '')('the kiosk', () => {
  let browser: Browser, served: Served, programme: Programme, line: Line;
  let kiosk: Kiosk, page: Page, palpation: string, probing: string;

  const screen = (name: string, timeout = kTrial_ms) => page.locator(`[data-screen="${name}"]`).waitFor({ timeout });
  const fault = (kind: string) => page.locator(`[data-fault="${kind}"]`).waitFor({ timeout: kTrial_ms });
  const touch = (name: string | RegExp) => page.getByRole('button', { name }).click();
  const assigned = (id: string) => programme.admin.ask<Assigned>('GET', `/assignments/${id}`);

  /** A picture, without faults of access, and nothing beside the screen. */
  async function look(name: string): Promise<void> {
    await page.screenshot({ path: `${kShots}kiosk-${name}.png` });
    expect(await accessibilityFaults(page), name).toEqual([]);
    const over = await page.locator('main').evaluate((main) => main.scrollHeight - main.clientHeight);
    expect(over, `${name} fits its screen`).toBeLessThanOrEqual(0);
  }

  async function open(words: string[]): Promise<void> {
    kiosk = await startKiosk(bin, line, programme, words);
    page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
    await page.goto(kiosk.address);
  }

  /** A scanner types the badge and Enter; a finger types the PIN. */
  async function signIn(badge: string): Promise<void> {
    await page.locator('[data-screen="badge"], [data-fault="interrupted"]').waitFor();
    await page.keyboard.type(`${badge}\n`);
    await screen('pin');
    for (const digit of kPin) await page.getByRole('button', { name: digit, exact: true }).click();
    await touch('OK');
    await screen('work');
  }

  async function answer(wall: string): Promise<void> {
    await screen('answer');
    await touch(wall);
    await touch(/75/);
    await touch('Give the answer');
  }

  beforeAll(async () => {
    browser = await launch();
    served = await serveReal(bin);
    programme = await furnish(served, bin);
    line = await Line.to(served.url);
    const { admin } = programme;
    const { cases } = await admin.ask<{ cases: { id: string; kind?: string; title: string }[] }>('GET', '/cases');
    const l3 = cases.find(({ title }) => title === 'L3 left pedicle')?.id ?? '';
    const give = (title: string, people: string[], given: unknown[], repeats: number) =>
      admin.ask<{ id: string }>('POST', '/assignments', { title, people, cases: given, repeats });
    ({ id: palpation } = await give('Week 1: palpation', ['Simulated Ada'], [{ case: l3 }], 3));
    ({ id: probing } = await give(
      'Week 1: probing',
      ['Simulated Ben'],
      [{ scenario: { tuned: 'lateral_breach' } }],
      4,
    ));
  }, 240_000);
  afterEach(async () => {
    await page.close();
    await kiosk.end();
  });
  afterAll(async () => {
    await browser.close();
    await line.cut();
    await served.stop();
  });

  it('takes a trainee from the badge to the result, and on through a cut network', async () => {
    await open(['--device', 'sim-lambda6', '--duration', '12', '--seed', '7']);
    await screen('badge');
    await look('badge');
    await page.keyboard.type(`${kAda}\n`);
    await screen('pin');
    await page.keyboard.type('1111\n');
    await page.getByRole('alert').filter({ hasText: 'Badge or PIN is wrong.' }).waitFor();
    await look('pin-wrong');
    await touch('Back');
    await signIn(kAda);
    await look('work');
    await touch('Pause');
    await screen('paused');
    await look('paused');
    await touch('Go on');
    await touch('Start');
    await screen('running');
    await touch('Pause');
    await screen('paused');
    await look('paused-trial');
    await page.waitForTimeout(kPause_s * 1000);
    expect(await page.locator('[data-screen="paused"]').count(), 'a paused trial does not end').toBe(1);
    await touch('Go on');
    await screen('running');
    await page.getByText('Depth').waitFor();
    await look('running');
    await screen('answer');
    await look('answer');
    await answer('medial');
    await screen('result');
    await page.getByText('The server has it.').waitFor();
    await page.getByText('You see the result on your own page once it is released.').waitFor();
    await look('result');
    const first = await assigned(palpation);
    expect(first.done).toBe(1);
    const kept = await programme.admin.ask<Answered>('GET', `/trials/${first.trials[0]?.trial_id ?? ''}`);
    expect(kept.answer).toMatchObject({ breach: true, wall: 'medial', confidence: 0.75, depth_m: null });
    const pauses = kept.events.filter(({ kind }) => kind === 'paused');
    expect(pauses.length).toBe(1);
    expect(pauses[0]?.detail.lasted_s).toBeGreaterThan(kPause_s);
    // --duration 12, and the hand may lag by 2 s (kGrace_s): the pause is not in it.
    expect(kept.duration_s).toBeLessThan(12 + 2.1);

    await programme.admin.ask('POST', `/assignments/${palpation}/release`, { release: 'released' });
    await touch('Next trial');
    await screen('work');
    await touch('Start');
    await screen('running');
    await line.cut();
    await answer('No breach');
    await screen('result');
    await page.getByText('is safe at this station').waitFor();
    await look('result-not-sent');
    await touch('Next trial');
    await fault('network');
    await look('fault-network');
    expect((await assigned(palpation)).done).toBe(1);
    await line.mend();
    await touch('Try again');
    await screen('work');
    expect((await assigned(palpation)).done).toBe(2);
    await page.getByText('Trial 3 of 3').waitFor();
    await touch('Sign out');
    await screen('badge');
  }, 240_000);

  it('keeps what a killed station recorded, and says so to whoever comes next', async () => {
    const count = async () =>
      (await programme.admin.ask<{ trials: unknown[] }>('GET', '/trials?limit=50')).trials.length;
    const before = await count();
    await open(['--device', 'sim-lambda6', '--duration', '20', '--seed', '9']);
    await signIn(kAda);
    await touch('Start');
    await screen('running');
    await page.waitForTimeout(3000);
    await kiosk.end('SIGKILL');
    await fault('lost');
    await look('fault-lost');
    await page.close();
    await open(['--device', 'sim-lambda6', '--duration', '5']);
    await fault('interrupted');
    await look('fault-interrupted');
    await expect.poll(count).toBe(before + 1);
    await signIn(kAda);
  }, 240_000);

  it('asks a probing trial without showing its depth, and takes where the breach was felt', async () => {
    await open(['--device', 'sim-rig', '--seed', '7']);
    await signIn(kBen);
    await look('work-probing');
    await touch('Start');
    await screen('running');
    await page.getByText('This trial shows no depth.').waitFor();
    expect(await page.getByText('Depth', { exact: true }).count()).toBe(0);
    await look('running-probing');
    await screen('answer');
    const lateral = page.getByRole('button', { name: 'lateral' });
    const box = await lateral.boundingBox();
    await lateral.click({ position: { x: 20, y: (box?.height ?? 0) / 4 } });
    await look('answer-probing');
    await touch(/75/);
    await touch('Give the answer');
    await screen('result');
    const { trials } = await assigned(probing);
    const kept = await programme.admin.ask<Answered>('GET', `/trials/${trials[0]?.trial_id ?? ''}`);
    expect(kept.answer?.wall).toBe('lateral');
    expect(kept.answer?.depth_m).toBeCloseTo(0.01, 3); // a quarter of travel_m, 0.04 in shared/scenarios/tuned/lateral_breach.json
  }, 240_000);

  it('starts a trial by the button of the device, pauses it, and shows the result that is released', async () => {
    await programme.admin.ask('POST', `/assignments/${probing}/release`, { release: 'released' });
    const before = new Set((await assigned(probing)).trials.map(({ trial_id }) => trial_id));
    const rig = await startRig(bin);
    await open(['--device', 'rig', '--address', rig.address]);
    await signIn(kBen);
    await page.getByText('Or press the button of the device.').waitFor();
    await look('work-button');
    await rig.press(kStartButton, 1);
    await screen('running');
    await rig.press(kStartButton, 0);
    await touch('Pause');
    await screen('paused');
    await touch('Go on');
    await screen('running');
    await touch('I am done');
    await answer('No breach');
    await screen('result');
    await page.getByText('Mean force').waitFor();
    await look('result-released');
    const made = (await assigned(probing)).trials.find(({ trial_id }) => !before.has(trial_id));
    const kept = await programme.admin.ask<Answered>('GET', `/trials/${made?.trial_id ?? ''}`);
    expect(kept.events.filter(({ kind }) => kind === 'paused').length).toBe(1);
    await touch('Sign out');
    await screen('badge');
    await rig.end();
  }, 240_000);

  it('stops for the red button and for a rig that is gone, and goes on when a person says so', async () => {
    const rig = await startRig(bin);
    await open(['--device', 'rig', '--address', rig.address]);
    await signIn(kBen);
    await touch('Start');
    await screen('running');
    await rig.press(kStopButton, 1);
    await fault('emergency_stop');
    await look('fault-emergency-stop');
    await touch('It is safe: go on');
    await screen('work');
    await touch('Start');
    await fault('emergency_stop'); // the button is still pressed
    await rig.press(kStopButton, 0);
    await rig.press(kResetButton, 1);
    await touch('It is safe: go on');
    await screen('running');
    await rig.end();
    await fault('device');
    await look('fault-device');
    await touch('Sign out');
    await screen('badge');
  }, 240_000);

  it('is stopped by a supervisor, and signs out whom nobody sees', async () => {
    await open(['--device', 'sim-lambda6', '--duration', '20', '--idle', '5']);
    await signIn(kAda);
    await touch('Start');
    await screen('running');
    const reason = 'the probe has come loose';
    await programme.admin.ask('POST', `/stations/${programme.station.id}/stop`, { reason });
    await fault('stopped');
    await page.getByText(reason).waitFor();
    await look('fault-stopped');
    await touch('Go on');
    await screen('work');
    await fault('timed_out');
    await look('fault-timed-out');
  }, 120_000);

  it('opens the browser without a secret in its arguments, and anew when it ends', async () => {
    await open(['--device', 'sim-lambda6']);
    await kiosk.end();
    const starts = join(served.folder, 'starts'),
      browserStandIn = join(served.folder, 'browser');
    writeFileSync(browserStandIn, `#!/bin/sh\necho "$@" >> ${starts}\nsleep 1\n`, { mode: 0o755 });
    const ended = shown(bin, line, programme, ['--device', 'sim-lambda6', '--browser', browserStandIn]);
    const lines = () => (existsSync(starts) ? readFileSync(starts, 'utf8').trim().split('\n') : []);
    await expect.poll(() => lines().length, { timeout: 20_000 }).toBeGreaterThan(1);
    await ended();
    const start = join(programme.station.folder, 'kiosk', 'start.html');
    const secret = /#([0-9a-f]{64})/.exec(readFileSync(start, 'utf8'))?.[1] ?? '';
    expect(secret).not.toBe('');
    expect(statSync(start).mode & 0o777).toBe(0o600);
    expect(lines().join()).toContain(`file://${start}`);
    expect(lines().join()).not.toContain(secret);
  }, 60_000);

  it('tests the station for a technician who knows the PIN', async () => {
    const file = join(served.folder, 'technician-pin');
    writeFileSync(file, '8642\n');
    await open(['--device', 'sim-lambda6', '--technician-pin-file', file]);
    await touch('Technician');
    await screen('technician_pin');
    await page.keyboard.type('8642\n');
    await screen('technician');
    await page.getByText('largest force').waitFor();
    await page.getByText(/version \d/).waitFor();
    await look('technician');
    await touch('Self-test');
    await screen('testing');
    await screen('technician', 120_000);
    await page.getByText('time of day').waitFor();
    await look('technician-tested');
    const { stations } = await programme.admin.ask<{ stations: { self_test: { passed: boolean } | null }[] }>(
      'GET',
      '/stations',
    );
    expect(stations[0]?.self_test).not.toBeNull();
    await touch('Back');
    await screen('badge');
  }, 240_000);

  it('locks a badge after wrong PINs as the server says', async () => {
    await open(['--device', 'sim-rig']);
    await screen('badge');
    await page.keyboard.type(`${kBen}\n`);
    await screen('pin');
    for (let i = 0; i < 10 && (await page.locator('[data-fault="locked"]').count()) === 0; ++i) {
      await page.keyboard.type('1111\n');
      await page.waitForTimeout(300);
    }
    await fault('locked');
    await look('fault-locked');
  }, 120_000);
});
