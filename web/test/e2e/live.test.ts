/** The wall of stations over its socket: moves, loses its line, comes back, stops a station. On the simulated server, whose fleet is known. */
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { launch, signIn, visit } from './browser';

describe.skipIf(!inject('fixture'))('the live view of stations', () => {
  let browser: Browser;
  beforeAll(async () => {
    browser = await launch();
  });
  afterAll(() => browser.close());

  it('moves by itself, says in words what needs a person, and puts it first', async () => {
    const { context, page, faults } = await visit(browser);
    await signIn(page, '/wall');
    const running = page.locator('[data-station="skills lab 1"]');
    const time = running.locator('dt', { hasText: 'Time' }).locator('+ dd');
    const first = await time.innerText();
    await expect.poll(() => time.innerText()).not.toBe(first);
    expect(await page.locator('[data-station]').first().getAttribute('data-station')).toBe('theatre 4');
    expect(await page.locator('[data-part="summary"]').innerText()).toBe(
      '1 in use, 1 needing attention, 1 available, 1 offline',
    );
    expect(faults).toEqual([]);
    await context.close();
  });

  it('keeps what it knew while the connection is lost, says so, and comes back by itself', async () => {
    const { context, page } = await visit(browser);
    await signIn(page, '/wall');
    await page.locator('[data-station]').first().waitFor();
    await page.evaluate(() => fetch('/api/v1/stations/cut', { method: 'POST', headers: { 'X-Tractus': '1' } }));
    await page.locator('[data-connection="lost"]').waitFor();
    expect(await page.locator('[data-station]').count()).toBe(4);
    await page.locator('[data-connection="open"]').waitFor();
    await context.close();
  });

  it('stops a station only with a reason', async () => {
    const { context, page } = await visit(browser);
    await signIn(page, '/wall');
    await page.getByRole('button', { name: 'Stop skills lab 1' }).click();
    const deed = page.getByRole('button', { name: 'Stop now' });
    expect(await deed.isDisabled()).toBe(true);
    await page.getByLabel('Reason').fill('the probe has come loose');
    await deed.click();
    await page.locator('[data-station="skills lab 1"]').getByText('Stopped', { exact: true }).waitFor();
    await context.close();
  });
});
