/** Figures of the pages, printed: a trial of 10⁶ samples from the fixture, drawn without a graphics processor. */
import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { gzipSync } from 'node:zlib';
import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import { launch, signIn, visit } from './browser';

const kAssets = fileURLToPath(new URL('../../dist/assets/', import.meta.url));

const firstPaint_ms = (page: Page) =>
  page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? Number.NaN);

/** Presses a key at every frame for three seconds: how often was drawn, and how long the page itself was busy. */
async function held(page: Page, key: string) {
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable');
  const busy_s = async () => {
    const { metrics } = await session.send('Performance.getMetrics');
    return metrics.find(({ name }) => name === 'TaskDuration')?.value ?? Number.NaN;
  };
  const before = await busy_s();
  const waits = await page.evaluate(async (name) => {
    const panels = document.querySelector<HTMLElement>('[data-part="panels"]');
    const found: number[] = [];
    let last = performance.now();
    const end = last + 3000;
    while (last < end) {
      panels?.dispatchEvent(new KeyboardEvent('keydown', { key: name, bubbles: true, cancelable: true }));
      await new Promise(requestAnimationFrame);
      const now = performance.now();
      found.push(now - last);
      last = now;
    }
    return found.sort((a, b) => a - b);
  }, key);
  const busy = (await busy_s()) - before;
  const at = (share: number) =>
    Math.round(waits[Math.min(waits.length - 1, Math.floor(waits.length * share))] ?? Number.NaN);
  return `${(waits.length / 3).toFixed(0)} frames/s; wait median ${at(0.5)} ms, p95 ${at(0.95)} ms, longest ${at(1)} ms; the page busy ${((1000 * busy) / waits.length).toFixed(1)} ms a frame`;
}

it('prints its figures', async () => {
  // Plain drawing on the processor: with GL in software a frame waits for the compositor and not for the page.
  const browser = await launch(['--disable-gpu']);
  const { page } = await visit(browser);
  await page.goto('/');
  await page.getByLabel('Name').waitFor();
  console.log('first paint, sign-in, ms:', Math.round(await firstPaint_ms(page)));
  await signIn(page);
  let volume_B = 0;
  page.on('response', (response) => {
    if (response.url().includes('/preview'))
      void response.body().then(
        (body) => {
          volume_B += body.length;
        },
        () => undefined,
      );
  });
  await page.goto('/trials/trial-001');
  await page.locator('[data-panel="force"] canvas').waitFor();
  console.log('first paint, trial, ms:', Math.round(await firstPaint_ms(page)));
  await page.getByText(/minimum and maximum/).waitFor();
  console.log('signals of 10⁶ samples on the screen, ms:', Math.round(await page.evaluate(() => performance.now())));
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  const devtools = await page.context().newCDPSession(page);
  await devtools.send('HeapProfiler.collectGarbage');
  const { usedSize, embedderHeapUsedSize, backingStorageSize } = (await devtools.send('Runtime.getHeapUsage')) as {
    usedSize: number;
    embedderHeapUsedSize?: number;
    backingStorageSize?: number;
  };
  console.log(
    `the bone in 3-D: ${(volume_B / 1e6).toFixed(2)} MB came; the whole page holds ${((usedSize + (embedderHeapUsedSize ?? 0) + (backingStorageSize ?? 0)) / 1e6).toFixed(0)} MB`,
  );
  await page.waitForTimeout(1500);
  console.log('zooming in:', await held(page, '+'));
  await page.locator('[data-part="panels"]').press('0');
  for (let i = 0; i < 8; ++i) await page.locator('[data-part="panels"]').press('+');
  await page.waitForTimeout(800);
  const panning = await held(page, 'ArrowRight');
  console.log('panning at 1/25 of 10⁶ samples:', panning);
  for (const file of readdirSync(kAssets).filter((name) => /\.(js|css)$/.test(name))) {
    const bytes = readFileSync(kAssets + file);
    console.log(file, `${(bytes.length / 1000).toFixed(0)} kB,`, `${(gzipSync(bytes).length / 1000).toFixed(0)} kB gz`);
  }
  expect(panning).toContain('frames/s');
  await browser.close();
}, 120_000);
