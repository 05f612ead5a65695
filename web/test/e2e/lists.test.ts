/** Lists that the server searches, sorts and cuts into pages: what is shown is in the address, and can be saved under a name. */
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import type { Browser, Page } from 'playwright-core';
import { accessibilityFaults } from './axe';
import { kShots, launch, signIn, visit } from './browser';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

const query = (page: Page) => Object.fromEntries(new URL(page.url()).searchParams);
const rows = (page: Page) => page.locator('tbody tr');
const counted = (page: Page, text: string) => page.getByRole('status').filter({ hasText: text }).waitFor();

describe.runIf(inject('fixture'))('a list', () => {
  it('is searched, filtered, sorted and turned, all in its address', async () => {
    const { context, page, faults } = await visit(browser);
    await signIn(page, '/trials');
    await counted(page, '64 in all');
    await page.getByRole('button', { name: 'Next' }).click();
    await page.waitForURL(/cursor=/);
    await expect.poll(() => rows(page).count()).toBe(14); // the page before stays until the next is there
    await page.goBack();
    await rows(page).nth(49).waitFor();

    await page.getByLabel('Find by person, case or station').fill('lab 2');
    await counted(page, '16 found');
    await page.getByRole('group', { name: 'Answer' }).getByRole('button', { name: 'incorrect' }).click();
    await page.getByRole('button', { name: 'Duration' }).click();
    await page.waitForURL(/sort=duration/);
    expect(query(page)).toEqual({ search: 'lab 2', answer: 'incorrect', sort: 'duration' });
    await page.waitForLoadState('networkidle');
    const shown = await rows(page).allInnerTexts();
    await page.reload();
    await rows(page).first().waitFor();
    await expect.poll(() => rows(page).allInnerTexts()).toEqual(shown); // the address leads to the same rows

    await page.getByLabel('Find by person, case or station').fill('nothing like it');
    await page.getByText('No rows match.').waitFor();
    expect(faults).toEqual([]);
    await context.close();
  });

  it('is saved under a name, opened and removed', async () => {
    const { context, page } = await visit(browser);
    await signIn(page, '/trials?answer=incorrect&sort=person');
    await rows(page).first().waitFor();
    await page.getByRole('button', { name: 'Save this view…' }).click();
    await page.getByLabel('Name', { exact: true }).fill('Failures by person');
    await page.getByRole('button', { name: 'Save', exact: true }).click();
    const view = page.getByRole('button', { name: 'Failures by person', exact: true });
    await view.waitFor();
    expect(await view.getAttribute('aria-pressed')).toBe('true');
    await page.goto('/trials');
    await view.click();
    await page.waitForURL(/answer=incorrect/);
    expect(query(page)).toEqual({ answer: 'incorrect', sort: 'person' });
    await page.getByRole('button', { name: 'Remove the view Failures by person' }).click();
    await page.getByRole('button', { name: 'Remove', exact: true }).click();
    await view.waitFor({ state: 'detached' });
    await context.close();
  });

  it('of assignments begins with the overdue one', async () => {
    const { context, page } = await visit(browser);
    await signIn(page, '/assignments');
    await rows(page).first().getByText('overdue').waitFor();
    await page.getByRole('button', { name: 'Assignment', exact: true }).click();
    await page.waitForURL(/sort=title/);
    await context.close();
  });

  it('of accounts and changes is narrowed by role', async () => {
    const { context, page } = await visit(browser);
    await signIn(page, '/network/people');
    await page.getByRole('group', { name: 'Role', exact: true }).getByRole('button', { name: 'Trainee' }).click();
    await counted(page, '3 found');
    await page.goto('/network/audit');
    await page.getByLabel('Find by account, action, object or details').fill('addCohort');
    await counted(page, '1 found');
    await context.close();
  });

  it('looks right at every width, light and dark', async () => {
    for (const dark of [false, true]) {
      const { context, page } = await visit(browser, { dark });
      await signIn(page, '/trials');
      for (const path of ['/trials', '/assignments', '/network/people', '/network/audit', '/cases']) {
        await page.goto(path);
        await rows(page).first().waitFor();
        for (const width of [1440, 820, 390]) {
          await page.setViewportSize({ width, height: 900 });
          const name = `list${path.replaceAll('/', '-')}-${String(width)}${dark ? '-dark' : ''}`;
          await page.screenshot({ path: `${kShots}${name}.png` });
          const over = await page.evaluate(
            () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
          );
          expect(over, name).toBeLessThanOrEqual(0);
          expect(await accessibilityFaults(page), name).toEqual([]);
        }
        await page.setViewportSize({ width: 1440, height: 900 });
      }
      await context.close();
    }
  }, 180_000);
});
