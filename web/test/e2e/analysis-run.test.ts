/** An analysis that takes long is stopped from its page. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { launch, signIn, visit } from './browser';

let browser: Browser, page: Page;
beforeAll(async () => {
  browser = await launch();
  ({ page } = await visit(browser, {}));
  await signIn(page);
});
afterAll(() => browser.close());

describe.runIf(inject('fixture'))('an analysis that runs', () => {
  it('shows how far it is, and ends when a person cancels it', async () => {
    const { id } = await page.evaluate(async () => {
      const answer = await fetch('/api/v1/cohort/analyses', {
        method: 'POST',
        headers: { 'Content-Type': 'application/json', 'X-Tractus': '1' },
        body: JSON.stringify({ method: 'lmm', formula: 'probing_time ~ trial + (1 | surgeon)' }),
      });
      return (await answer.json()) as { id: string };
    });
    await page.goto(`/analysis/runs/${id}`);
    expect(await page.getByRole('progressbar', { name: 'Progress' }).getAttribute('value')).toBe('0.3');
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByText('The analysis was stopped.').waitFor();
    await page.getByText(/^stopped by /).waitFor();
    expect(await page.getByRole('button', { name: 'Cancel' }).count()).toBe(0);
  });
});
