/** Pages on a telephone: nothing is wider than the screen. */
import { afterAll, beforeAll, expect, inject, it } from 'vitest';
import type { Browser } from 'playwright-core';
import { launch, signIn, visit } from './browser';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

it.runIf(inject('fixture'))(
  'no page is wider than a screen of 390 px',
  async () => {
    const { context, page } = await visit(browser, { width: 390 });
    await signIn(page);
    const wider: string[] = [];
    for (const address of [
      '/trials',
      '/cases',
      '/scenarios',
      '/assignments',
      '/trainees',
      '/cohorts',
      '/studies',
      '/analysis',
      '/analysis/example',
      '/lab',
      '/lab/versions',
      '/wall',
      '/network/people',
      '/network/cohorts',
      '/network/stations',
      '/network/backups',
      '/network/retention',
      '/network/audit',
      '/guide/faculty',
      '/account',
      '/account/tokens',
      '/network/tokens',
      '/guide/first-week',
      '/guide/scripts',
    ]) {
      await page.goto(address);
      await page.waitForLoadState('networkidle');
      const overflow = await page.evaluate(
        () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
      );
      if (overflow > 0) wider.push(`${address}: ${overflow} px`);
    }
    expect(wider).toEqual([]);
    await context.close();
  },
  180_000,
); // two dozen pages, each until its network is idle
