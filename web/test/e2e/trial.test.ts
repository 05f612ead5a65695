/** A trial as its reader uses it: list, chart, numbers, walls, 3-D. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { asked, assessedTrial, launch, signIn, visit, type Visit } from './browser';
import { inked, pictureOf } from './pixels';

interface Metric {
  id: string;
  unit: string;
  value: number | null;
}
interface Served {
  id: string;
  case_title: string;
  operator_name: string;
  duration_s: number;
  metrics: Metric[];
  coverage: { samples: number[] } | null;
}

const served = (page: Page, trial: string) => asked<Served>(page, `/trials/${trial}`);
const spaced = (text: string) => text.replaceAll('\u202f', ' ').trim();

/** What is shown, read back as a number of SI; "< 0.001" is a bound. */
function si(text: string, perSi: number): { value: number; bound: boolean } {
  const plain = spaced(text)
    .replace('−', '-')
    .replace(/^([<>]) /, '')
    .replace(/ (?=\d)/g, '');
  return { value: Number.parseFloat(plain) / perSi, bound: /^[<>]/.test(spaced(text)) };
}

let browser: Browser;
let seen: Visit;
let id: string;
beforeAll(async () => {
  browser = await launch();
  seen = await visit(browser);
  await signIn(seen.page);
  id = await assessedTrial(seen.page);
});
afterAll(() => browser.close());

async function openTrial(page: Page): Promise<void> {
  await page.goto(`/trials/${id}`);
  await page.locator('[data-panel="force"] canvas').waitFor();
  await page.getByText(/minimum and maximum|every sample/).waitFor();
}

const range = async (page: Page) => spaced(await page.locator('[data-part="range"]').innerText());
const span = async (page: Page) => {
  const [from = 0, to = 0] = (await range(page)).match(/[\d.]+/g)?.map(Number) ?? [];
  return to - from;
};

it('the list shows what the server lists, and its link opens the trial', async () => {
  const { page } = seen;
  const { trials } = await asked<{ trials: Served[] }>(page, '/trials?limit=50');
  await page.goto('/trials');
  await page.locator('tbody a').first().waitFor();
  expect(await page.locator('tbody tr').count()).toBe(trials.length);
  const index = trials.findIndex((trial) => trial.id === id);
  const row = page.locator('tbody tr').nth(index);
  expect(await row.innerText()).toContain(trials[index]!.operator_name);
  await row.getByRole('link').click();
  await page.getByRole('heading', { level: 1, name: trials[index]!.case_title }).waitFor();
  expect(new URL(page.url()).pathname).toBe(`/trials/${id}`);
});

describe('the chart', () => {
  it('draws every panel', async () => {
    const { page } = seen;
    await openTrial(page);
    for (const panel of ['force', 'torque', 'place', 'tilt']) {
      const canvas = page.locator(`[data-panel="${panel}"] canvas`).first();
      await expect.poll(() => inked(canvas), { timeout: 15_000 }).toBeGreaterThan(3000);
    }
  });

  it('zooms to what is dragged across, fetches finer detail there, and shows the whole again', async () => {
    const { page } = seen;
    await openTrial(page);
    const whole = await span(page);
    const over = page.locator('[data-panel="force"] .u-over');
    const box = (await over.boundingBox())!;
    const finer = page.waitForResponse((answer) => answer.url().includes('/signals?') && answer.ok());
    await page.mouse.move(box.x + box.width * 0.4, box.y + 40);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width * 0.5, box.y + 60, { steps: 8 });
    await page.mouse.up();
    const answer = await finer;
    // A tenth of the width was dragged.
    expect((await span(page)) / whole).toBeGreaterThan(0.09);
    expect((await span(page)) / whole).toBeLessThan(0.11);
    const asked = new URL(answer.url()).searchParams;
    expect(Number(asked.get('to_s')) - Number(asked.get('from_s'))).toBeLessThan(whole * 0.6);
    const detail = (await answer.json()) as { samples_per_point: number };
    const trial = await served(page, id);
    expect(detail.samples_per_point).toBeLessThan(Math.max(2, (trial.duration_s * 4000) / 1024));
    await over.dblclick();
    await expect.poll(() => span(page)).toBeCloseTo(whole, 3);
  });

  it('goes down to every sample, by keys and by the wheel, and reads values under the pointer', async () => {
    const { page } = seen;
    await openTrial(page);
    const panels = page.locator('[data-part="panels"]');
    await panels.focus();
    await page.keyboard.press('+');
    const once = await span(page);
    await page.keyboard.press('ArrowRight');
    expect(Number((await range(page)).match(/[\d.]+/)?.[0])).toBeGreaterThan(0);
    const box = (await page.locator('[data-panel="force"] .u-over').boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    for (let turn = 0; turn < 12; ++turn) await page.mouse.wheel(0, -400);
    await expect.poll(() => span(page)).toBeLessThan(once / 100);
    await page.getByText('every sample').waitFor();
    await page.mouse.move(box.x + box.width / 2 + 5, box.y + box.height / 2);
    await expect
      .poll(async () => spaced(await page.locator('[data-channel="force_xy_N"]').innerText()))
      .toMatch(/^[<\d. ]+ N$/);
    await page.keyboard.press('0');
  });

  it('leaves the wheel to the page until it has the focus', async () => {
    const { page } = seen;
    await openTrial(page);
    const before = await range(page);
    const box = (await page.locator('[data-panel="force"] .u-over').boundingBox())!;
    await page.mouse.move(box.x + 200, box.y + 40);
    await page.mouse.wheel(0, 300);
    await expect.poll(() => page.evaluate(() => window.scrollY)).toBeGreaterThan(100);
    expect(await range(page)).toBe(before);
  });
});

it('every measure in the tables is the number of the server, to the digits shown', async () => {
  const { page } = seen;
  await openTrial(page);
  const { metrics } = await served(page, id);
  expect(metrics.length).toBeGreaterThan(12);
  for (const metric of metrics) {
    const cell = page.locator(`[data-metric="${metric.id}"]`);
    const text = spaced(
      (await cell.locator('button').count()) > 0 ? await cell.locator('button').innerText() : await cell.innerText(),
    );
    if (metric.value === null) {
      expect(text, metric.id).toBe('–');
      continue;
    }
    if (metric.id === 'answer_right') {
      expect(text).toBe(metric.value === 1 ? 'correct' : 'incorrect');
      continue;
    }
    const perSi = text.endsWith('%') ? 100 : /\bmm\b/.test(text) ? 1000 : text.endsWith('°') ? 180 / Math.PI : 1;
    const shown = si(text, perSi);
    const decimals = /\.(\d+)/.exec(text)?.[1]?.length ?? 0;
    const tolerance = (0.5001 * 10 ** -decimals) / perSi;
    if (shown.bound) expect(Math.abs(shown.value - Math.abs(metric.value)), metric.id).toBeLessThan(2.5 * tolerance);
    else
      expect(Math.abs(shown.value - metric.value), `${metric.id}: ${text} for ${metric.value}`).toBeLessThanOrEqual(
        tolerance,
      );
  }
});

it('a measure tells its definition on focus, and Escape closes it', async () => {
  const { page } = seen;
  await openTrial(page);
  const term = page.locator('[data-metric="force_xy_mean"] button');
  await term.focus();
  const tip = page.locator('[data-metric="force_xy_mean"] [role="tooltip"]');
  await tip.waitFor({ state: 'visible' });
  await page.keyboard.press('Escape');
  await tip.waitFor({ state: 'hidden' });
});

it('the walls show as many touched cells as the server counted', async () => {
  const { page } = seen;
  await openTrial(page);
  const { coverage } = await served(page, id);
  const cells = await page.locator('path[data-heat]').evaluateAll((paths) =>
    paths.map((path) => ({
      heat: Number(path.getAttribute('data-heat')),
      cells: (path.getAttribute('d') ?? '').split('M').length - 1,
    })),
  );
  const touched = cells.filter(({ heat }) => heat > 0).reduce((total, { cells: n }) => total + n, 0);
  expect(touched).toBe(coverage?.samples.filter((n) => n > 0).length ?? 0);
});

describe('the tract in 3-D', () => {
  it('is drawn, turns with the keys, and comes back', async () => {
    const { page, faults } = seen;
    await openTrial(page);
    const scene = page.locator('[data-part="scene"]');
    await page.locator('[data-part="scene"][data-ready]').waitFor();
    await scene.scrollIntoViewIfNeeded();
    await expect.poll(async () => (await pictureOf(browser, scene)).colours, { timeout: 30_000 }).toBeGreaterThan(40);
    const first = await pictureOf(browser, scene);
    await scene.focus();
    for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowRight');
    await expect
      .poll(async () => (await pictureOf(browser, scene)).png.equals(first.png), { timeout: 15_000 })
      .toBe(false);
    await page.getByRole('button', { name: 'Hide the bone' }).click();
    await page.getByRole('button', { name: 'Reset the view' }).click();
    await expect.poll(async () => (await pictureOf(browser, scene)).colours, { timeout: 15_000 }).toBeGreaterThan(15);
    expect(faults).toEqual([]);
  });

  it('can be left and come back to more often than a browser holds contexts', async () => {
    const { page, faults } = seen;
    await openTrial(page);
    for (let visits = 0; visits < 18; ++visits) {
      await page.locator('[data-part="scene"][data-ready]').waitFor();
      await page.getByRole('link', { name: '← Trials' }).click();
      await page.locator(`tbody a[href="/trials/${id}"]`).click();
    }
    await page.locator('[data-part="scene"][data-ready]').waitFor();
    expect(await page.getByText('lost the 3-D view').count()).toBe(0);
    expect(faults).toEqual([]);
  }, 120_000);

  it('is replaced by a sentence where the browser cannot draw it, and the page is otherwise whole', async () => {
    const blind = await launch(['--disable-3d-apis']);
    const { page, faults } = await visit(blind);
    await signIn(page);
    await openTrial(page);
    await page.getByText('This browser does not support WebGL 2').waitFor();
    await page.locator('[data-metric="force_xy_mean"]').waitFor();
    expect(faults).toEqual([]);
    await blind.close();
  });
});

it('nothing jumps while a trial comes in', async () => {
  const { page } = seen;
  await page.addInitScript(() => {
    const shifts: number[] = [];
    Object.assign(window, { shifts });
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) shifts.push((entry as unknown as { value: number }).value);
    }).observe({ type: 'layout-shift', buffered: true });
  });
  for (const path of ['/trials', `/trials/${id}`]) {
    await page.goto(path);
    await page.waitForLoadState('networkidle');
    const total = await page.evaluate(() =>
      (window as unknown as { shifts: number[] }).shifts.reduce((a, b) => a + b, 0),
    );
    expect(total, path).toBeLessThan(0.05); // half of what is commonly called good
  }
});

it.runIf(inject('fixture'))('what went wrong in a recording is told', async () => {
  const { page } = seen;
  await page.goto('/trials/trial-004');
  await page.getByText('incomplete recording').waitFor();
  await page.getByText(/Ticks were skipped/).waitFor();
  await page.goto('/trials/trial-003');
  await page.getByText('The assessment of this trial failed.').waitFor();
  await page.getByText('This trial has no measures.').waitFor();
});
