/** Pictures that the tests make: for a look at the pages, and with GUIDE_PICTURES=1 those of the guide. */
import { mkdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { kShots } from './browser';

const kPictures = fileURLToPath(new URL('../../src/features/guide/pictures/', import.meta.url));

/**
 * The upper part of a page, 1200 × 750. `from`: what the picture begins with; the top of the page without. `language`: of the page; pictures of
 * another than English have a folder of their own.
 */
export async function picture(page: Page, name: string, from?: string, language = 'en'): Promise<void> {
  const own = language === 'en' ? '' : `${language}/`;
  const before = page.viewportSize();
  await page.setViewportSize({ width: 1200, height: 750 });
  await page.waitForLoadState('networkidle');
  await page.waitForTimeout(600);
  await page.evaluate((selector) => {
    if (selector) document.querySelector(selector)?.scrollIntoView({ block: 'start' });
    else window.scrollTo(0, 0);
  }, from);
  await page.screenshot({ path: `${kShots}guide-${own.replace('/', '-')}${name}.png` });
  if (process.env.GUIDE_PICTURES) {
    mkdirSync(`${kPictures}${own}`, { recursive: true });
    await page.screenshot({ path: `${kPictures}${own}${name}.jpg`, type: 'jpeg', quality: 75 });
  }
  if (before) await page.setViewportSize(before);
}
