/** What is around a picture: files to take with one, labels of sliders and ticks of a depth axis that a person can read, the zone of times. */
import { readFileSync } from 'node:fs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, inject, it } from 'vitest';
import { asked, launch, signIn, visit } from './browser';

let browser: Browser, page: Page;
beforeAll(async () => {
  browser = await launch();
  ({ page } = await visit(browser));
  await signIn(page);
});
afterAll(() => browser.close());

const fixture = inject('fixture');

it.runIf(fixture)('a chart comes as PNG, SVG and CSV', async () => {
  await page.goto('/cohorts');
  const files = page.getByRole('group', { name: /^Download the chart/ }).first();
  await files.waitFor();
  const content = async (kind: string) => {
    const [download] = await Promise.all([
      page.waitForEvent('download'),
      files.getByText(kind, { exact: true }).click(),
    ]);
    expect(download.suggestedFilename()).toMatch(new RegExp(`\\.${kind.toLowerCase()}$`));
    return readFileSync(await download.path());
  };
  // PNG (ISO/IEC 15948), 5.2: the signature of a file.
  expect((await content('PNG')).subarray(0, 8)).toEqual(Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]));
  expect((await content('SVG')).toString()).toMatch(/^<svg [^>]*xmlns="http:\/\/www\.w3\.org\/2000\/svg"/);
  const [head = '', ...rows] = (await content('CSV')).toString().trim().split('\n');
  expect(head.split(',').length).toBeGreaterThan(1);
  expect(rows.length).toBeGreaterThan(1);
  for (const row of rows) expect(row.split(',').length).toBe(head.split(',').length);
});

it.runIf(fixture).each([1440, 820, 390])('labels of sliders stand apart at %d px', async (width) => {
  await page.setViewportSize({ width, height: 900 });
  const { volumes } = await asked<{ volumes: { id: string; state: string }[] }>(page, '/volumes');
  await page.goto(`/cases/new/${volumes.find(({ state }) => state === 'released')?.id ?? ''}`);
  await page.locator('input[type="range"]').first().waitFor();
  const over = await page.locator('label:has(input[type="range"])').evaluateAll((labels) =>
    labels.flatMap((label) => {
      const parts = [...label.querySelectorAll('span[aria-hidden="true"], input')].map((part) => ({
        text: part.textContent || 'slider',
        box: part.getBoundingClientRect(),
      }));
      return parts.flatMap((one, i) =>
        parts
          .slice(i + 1)
          .filter(
            ({ box }) =>
              box.left < one.box.right - 0.5 &&
              one.box.left < box.right - 0.5 &&
              box.top < one.box.bottom - 0.5 &&
              one.box.top < box.bottom - 0.5,
          )
          .map((other) => `${one.text} over ${other.text}`),
      );
    }),
  );
  expect(await page.locator('label:has(input[type="range"])').count()).toBeGreaterThan(0);
  expect(over).toEqual([]);
});

it.runIf(fixture)('the axis of depth in a debriefing has ticks to read by', async () => {
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.goto('/trials/trial-001/debrief');
  const depth = page.getByRole('figure').filter({ hasText: 'depth' }).first();
  await depth.locator('svg text').first().waitFor();
  const numbers = (await depth.locator('svg text').allTextContents()).filter((text) => /^[−\d.]+$/.test(text.trim()));
  expect(numbers.length).toBeGreaterThanOrEqual(3);
});

it('the zone of times is named on every page', async () => {
  await page.goto('/trials');
  expect(await page.locator('footer').innerText()).toMatch(/^Times are in \S+/);
});
