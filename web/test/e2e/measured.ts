/** What is measured of a page: its width, axe-core's rules, its first paint, what came over the wire. */
import type { Page } from 'playwright-core';
import { accessibilityFaults } from './axe';

const kBetween_px = 820;
export const kWidths_px = [1440, kBetween_px, 390] as const;

export const overflow_px = (page: Page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

const paint_ms = (page: Page) =>
  page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? Number.NaN);

export interface Measured {
  readonly address: string;
  readonly firstPaint_ms: number;
  readonly faults: readonly string[];
}

/** By how much the page is wider than its window once its charts have their new width, or after 5 s. */
async function settled(page: Page): Promise<number> {
  let over = await overflow_px(page);
  for (let tries = 0; tries < 20 && (tries === 0 || over > 0); ++tries) {
    await page.waitForTimeout(tries === 0 ? 150 : 250);
    over = await overflow_px(page);
  }
  return over;
}

/** Opens the page anew; axe-core's rules at the widest and at the narrowest. */
export async function measured(page: Page, address: string): Promise<Measured> {
  await page.goto(address);
  await page.waitForLoadState('networkidle');
  const firstPaint_ms = await paint_ms(page);
  const faults: string[] = [];
  for (const width of kWidths_px) {
    await page.setViewportSize({ width, height: 900 });
    const over = await settled(page);
    if (over > 0) faults.push(`${address} at ${String(width)} px: ${String(over)} px wider than the window`);
    if (width === kBetween_px) continue;
    for (const fault of await accessibilityFaults(page)) faults.push(`${address} at ${String(width)} px: ${fault}`);
  }
  return { address, firstPaint_ms, faults };
}

/** The scripts of a first visit, as they came: bytes on the wire and how they were packed. */
export async function scriptsOf(
  page: Page,
  address: string,
): Promise<{ path: string; wire_B: number; coding: string }[]> {
  const waiting: Promise<{ path: string; wire_B: number; coding: string }>[] = [];
  page.on('requestfinished', (request) => {
    if (request.resourceType() !== 'script') return;
    waiting.push(
      (async () => {
        const response = await request.response();
        const { responseBodySize } = await request.sizes();
        const coding = (await response?.headerValue('content-encoding')) ?? '';
        return { path: new URL(request.url()).pathname, wire_B: responseBodySize, coding };
      })(),
    );
  });
  await page.goto(address);
  await page.waitForLoadState('networkidle');
  return Promise.all(waiting);
}
