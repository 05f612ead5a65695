/** Debian's Chromium as the tests use it: no network of its own, 3-D drawn by Mesa on the processor. */
import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { chromium, type Browser, type BrowserContext, type Page } from 'playwright-core';
import { inject } from 'vitest';

export const kShots = fileURLToPath(new URL('../screenshots/', import.meta.url));
mkdirSync(kShots, { recursive: true });

/** 3-D by OpenGL, as fast as it gets without a graphics processor; all else is painted without it, which takes half as long. */
const kDrawing = [
  '--use-gl=angle',
  '--use-angle=gl-egl',
  '--ignore-gpu-blocklist',
  '--disable-gpu-rasterization',
  '--disable-gpu-compositing',
];

/** `drawing` says how pictures are made. */
export function launch(drawing: readonly string[] = kDrawing): Promise<Browser> {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [
      '--no-sandbox',
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      ...drawing,
    ],
  });
}

export interface Visit {
  readonly context: BrowserContext;
  readonly page: Page;
  readonly faults: string[];
}

/** Sets the count of `jumped` to zero, after a change that a click asked for: a browser excuses it for 500 ms, a slow answer comes later. */
export const forgetJumps = (page: Page) =>
  page.evaluate(() => {
    Object.assign(window, { layoutShift: 0, layoutShiftOf: [] });
  });

/** How far the page has jumped since it was loaded (cumulative layout shift), and what jumped. Above 0.1 a person notices. */
export const jumped = (page: Page) =>
  page.evaluate(() => {
    const { layoutShift, layoutShiftOf } = window as unknown as { layoutShift: number; layoutShiftOf: string[] };
    return { layoutShift, layoutShiftOf };
  });

interface Look {
  readonly width?: number;
  readonly height?: number;
  readonly dark?: boolean;
}

/** A fresh person at a fresh screen. `faults` gathers what the page complains about: errors and refusals of the policy. */
export async function visit(browser: Browser, { width = 1440, height = 900, dark = false }: Look = {}): Promise<Visit> {
  const context = await browser.newContext({
    viewport: { width, height },
    colorScheme: dark ? 'dark' : 'light',
    baseURL: inject('url'),
  });
  await context.addInitScript(() => {
    const shifts = window as unknown as { layoutShift: number; layoutShiftOf: string[] };
    shifts.layoutShift = 0;
    shifts.layoutShiftOf = [];
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries() as (PerformanceEntry & {
        value: number;
        hadRecentInput: boolean;
        sources?: { node?: Node | null }[];
      })[]) {
        if (entry.hadRecentInput) continue;
        shifts.layoutShift += entry.value;
        for (const { node } of entry.sources ?? [])
          if (node instanceof Element)
            shifts.layoutShiftOf.push(`${node.tagName} ${node.className} ${entry.value.toFixed(3)}`);
      }
    }).observe({ type: 'layout-shift', buffered: true });
  });
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  const faults: string[] = [];
  page.on('pageerror', (error) => faults.push(String(error.stack)));
  page.on('console', (message) => {
    const text = message.text();
    // The browser writes every 4xx to the console; the pages expect a 401 before the sign-in.
    if (message.type() === 'error' && !/status of 4\d\d/.test(text)) faults.push(text);
  });
  return { context, page, faults };
}

export async function signIn(page: Page, path = '/'): Promise<void> {
  const account = inject('account');
  await page.goto(path);
  await page.getByLabel('Name').fill(account.name);
  await page.getByLabel('Password').fill(account.password);
  await page.getByRole('button', { name: 'Sign in' }).click();
  await page.getByRole('button', { name: 'Sign out' }).waitFor();
}

/** What the server answers to who is signed in on this page. */
export const asked = <Answer>(page: Page, path: string): Promise<Answer> =>
  page.evaluate(async (address) => (await fetch(address)).json() as Promise<Answer>, `/api/v1${path}`);

/** The id of the newest palpation trial that has been assessed. */
export async function assessedTrial(page: Page): Promise<string> {
  const { trials } = await asked<{ trials: { id: string; state: string }[] }>(page, '/trials?limit=50');
  for (const { id } of trials.filter(({ state }) => state === 'assessed')) {
    const { rig } = await asked<{ rig: string }>(page, `/trials/${id}`);
    if (rig === 'palpation') return id;
  }
  throw new Error('the server has no assessed palpation trial');
}

interface Told {
  participants: { name: string; slots: { state: string; trials: { id: string; state: string }[] }[] }[];
}

/** A study with a trial that counts, if the server has one: the newest of its trials behind a wall, or any. */
export async function someStudy(page: Page): Promise<{ id: string; trial: string } | null> {
  const { studies } = await asked<{ studies: { id: string; done: number }[] }>(page, '/studies');
  const found = studies.find(({ done }) => done > 0);
  if (!found) return null;
  const study = await asked<Told>(page, `/studies/${found.id}`);
  const trials = study.participants.flatMap((one) =>
    one.slots.flatMap((slot) => slot.trials.filter(({ state }) => state === 'counts')),
  );
  for (const { id } of trials.slice(0, 8)) {
    const { scenario } = await asked<{ scenario: { walls: unknown[] } | null }>(page, `/trials/${id}`);
    if (scenario && scenario.walls.length > 0) return { id: found.id, trial: id };
  }
  return trials[0] ? { id: found.id, trial: trials[0].id } : null;
}
