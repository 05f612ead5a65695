/** Coming in, being thrown out, and addresses that are typed. */
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, expect, inject, it } from 'vitest';
import { assessedTrial, jumped, launch, signIn, visit } from './browser';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

it('a wrong password is refused in words and the right one lets in, by keyboard alone', async () => {
  const { context, page, faults } = await visit(browser);
  await page.goto('/');
  await page.waitForFunction(() => document.activeElement?.getAttribute('name') === 'username');
  await page.keyboard.type(inject('account').name);
  await page.keyboard.press('Tab');
  await page.keyboard.type('not the password');
  await page.keyboard.press('Enter');
  await page.getByText('Name or password is wrong.').waitFor();
  await page.keyboard.type(inject('account').password); // the cursor is back in the emptied field
  await page.keyboard.press('Enter');
  await page.getByRole('heading', { name: 'Trials' }).waitFor();
  expect(faults).toEqual([]);
  await context.close();
});

it('an address of a trial survives the sign-in, and one of nothing says so', async () => {
  const { context, page } = await visit(browser);
  await signIn(page);
  const id = await assessedTrial(page);
  await page.getByRole('button', { name: 'Sign out' }).click();
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await signIn(page, `/trials/${id}`);
  await page.getByRole('heading', { name: 'Signals' }).waitFor();
  expect(new URL(page.url()).pathname).toBe(`/trials/${id}`);
  await page.goto('/trials/0123456789abcdef0123456789abcdef');
  await page.getByText('Trial not found.').waitFor();
  await context.close();
});

it('a session that ends in the middle leads to the sign-in and back to the same trial', async () => {
  const { context, page } = await visit(browser);
  await signIn(page);
  const id = await assessedTrial(page);
  await page.goto(`/trials/${id}`);
  await page.locator('[data-panel="force"] canvas').waitFor();
  await context.clearCookies();
  await page.getByRole('button', { name: 'Zoom in' }).click({ clickCount: 5 });
  await page.getByText('Your session has ended.').waitFor();
  await page.getByLabel('Name').fill(inject('account').name);
  await page.getByLabel('Password').fill(inject('account').password);
  await page.keyboard.press('Enter');
  await page.getByRole('heading', { name: 'Signals' }).waitFor();
  expect(new URL(page.url()).pathname).toBe(`/trials/${id}`);
  await context.close();
});

it('without the server the page says so, and finds it again', async () => {
  const { context, page } = await visit(browser);
  await signIn(page);
  await page.locator('tbody a').first().waitFor();
  await page.route('**/api/**', (route) => route.abort());
  await page.reload();
  await page.getByText('The server cannot be reached.').waitFor();
  await page.unroute('**/api/**');
  await page.getByRole('button', { name: 'Try again' }).click();
  await page.locator('tbody a').first().waitFor();
  await context.close();
});

it('the choice of dark is kept over a reload, without a flash of white', async () => {
  const { context, page } = await visit(browser);
  await page.goto('/');
  await page.getByLabel('Name').waitFor();
  const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await ground();
  const button = page.getByRole('button', { name: /Theme/ });
  await button.click();
  await button.click();
  const dark = await ground();
  expect(dark).not.toBe(light);
  // Noted when the body is first there: nothing can have been painted before.
  await page.addInitScript(() => {
    new MutationObserver((_, observer) => {
      if (document.body === null) return;
      Object.assign(window, { themeAtBody: document.documentElement.dataset.theme });
      observer.disconnect();
    }).observe(document, { childList: true, subtree: true });
  });
  await page.reload();
  await page.getByLabel('Name').waitFor();
  expect(await page.evaluate(() => (window as unknown as { themeAtBody?: string }).themeAtBody)).toBe('dark');
  expect(await ground()).toBe(dark);
  await context.close();
});

it('the first key leads over the header to the content', async () => {
  const { context, page } = await visit(browser);
  await signIn(page);
  await page.locator('tbody a').first().waitFor();
  await page.reload();
  await page.locator('tbody a').first().waitFor();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter');
  await page.keyboard.press('Tab');
  const focused = await page.evaluate(() => document.activeElement?.closest('main') !== null);
  expect(focused).toBe(true);
  await context.close();
});

it('nothing jumps when the server is slow to say who is signed in', async () => {
  const { context, page } = await visit(browser);
  await signIn(page);
  await page.route(/\/api\/v1\/session$/, async (route) => {
    await new Promise((resolve) => setTimeout(resolve, 900));
    await route.continue();
  });
  await page.goto('/network/retention');
  await page.getByRole('heading', { name: 'Rules now' }).waitFor();
  const { layoutShift, layoutShiftOf } = await jumped(page);
  expect(layoutShift, layoutShiftOf.join(', ')).toBeLessThan(0.02);
  await context.close();
});
