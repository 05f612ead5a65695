/** How a page is looked at: in both colour schemes, on a wide and a narrow screen; each page is loaded once a width. */
import type { Page } from 'playwright-core';
import { expect } from 'vitest';
import { accessibilityFaults } from './axe';
import { kShots } from './browser';

export interface Look {
  readonly width: number;
  readonly dark: boolean;
}
/** What a person opens; `checker` turns each page to the other scheme as well. */
export const kLooks: readonly Look[] = [
  { width: 1440, dark: false },
  { width: 800, dark: true },
];

export type Check = (name: string) => Promise<void>;

async function wear(page: Page, dark: boolean): Promise<void> {
  await page.emulateMedia({ colorScheme: dark ? 'dark' : 'light' });
  await page.evaluate(async () => {
    await Promise.allSettled(document.getAnimations().map(({ finished }) => finished));
  });
}

/** axe-core's rules in both schemes, nothing wider than the screen; with PICTURES=1 pictures for a person to look at. */
export function checker(page: Page, { width, dark }: Look, prefix = ''): Check {
  return async (name) => {
    for (const now of [dark, !dark]) {
      await wear(page, now);
      const scheme = now ? 'dark' : 'light';
      if (process.env.PICTURES)
        await page.screenshot({ path: `${kShots}${prefix}${name}-${String(width)}-${scheme}.png`, fullPage: true });
      const rules = now === dark ? 'all' : 'of colours'; // the others answer the same in both
      expect(await accessibilityFaults(page, rules), `${name}, ${scheme}`).toEqual([]);
    }
    const overflow = await page.evaluate(
      () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
    );
    expect(overflow, `${name}: pixels wider than the screen`).toBeLessThanOrEqual(0);
    await wear(page, dark);
  };
}
