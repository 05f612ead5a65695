/** Pictures of every page, for a person to look at, and axe-core's rules on each. */
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { assessedTrial, kShots, launch, signIn, someStudy, visit } from './browser';

const kAxe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

interface AxeRun { violations: { id: string; help: string; nodes: { target: string[]; failureSummary: string }[] }[] }

/** Through the debugger, which the page's policy on scripts does not concern. */
async function accessibilityFaults(page: Page): Promise<string[]> {
  await page.evaluate(kAxe);
  const run = await page.evaluate(() => (window as unknown as { axe: { run(): Promise<AxeRun> } }).axe.run());
  return run.violations.flatMap(({ id, help, nodes }) => nodes.map((node) => `${id}: ${help}: ${node.target.join(' ')} ${node.failureSummary}`));
}

let browser: Browser;
beforeAll(async () => { browser = await launch(); });
afterAll(() => browser.close());

describe.each([
  { width: 1440, dark: false }, { width: 1440, dark: true }, { width: 800, dark: false }, { width: 800, dark: true },
])('at $width px, dark: $dark', ({ width, dark }) => {
  it('every page can be used without sight, fits the screen and breaks no policy', async () => {
    const { context, page, faults } = await visit(browser, { width, dark });
    const suffix = `${width}-${dark ? 'dark' : 'light'}`;
    const check = async (name: string) => {
      await page.screenshot({ path: `${kShots}${name}-${suffix}.png`, fullPage: true });
      expect(await accessibilityFaults(page), name).toEqual([]);
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      expect(overflow, `${name}: pixels wider than the screen`).toBeLessThanOrEqual(0);
    };

    await page.goto('/');
    await page.getByLabel('Name').waitFor();
    await check('sign-in');

    await signIn(page);
    await page.getByRole('link', { name: /./ }).nth(2).waitFor();
    await page.locator('tbody a').first().waitFor();
    await check('trials');

    await page.goto(`/trials/${await assessedTrial(page)}`);
    await page.locator('[data-part="scene"][data-ready]').waitFor();
    await page.locator('[data-panel="force"] canvas').waitFor();
    await page.waitForLoadState('networkidle');
    await page.waitForTimeout(800);
    await check('trial');

    const study = await someStudy(page);
    if (study) {
      await page.goto('/studies');
      await page.locator('tbody a').first().waitFor();
      await check('studies');

      await page.goto(`/studies/${study.id}`);
      await page.locator('[data-participant]').first().waitFor();
      await check('study');
      await page.locator('[data-participant] button[aria-expanded]').first().click();
      await page.getByRole('button', { name: /^Mark trial/ }).first().click();
      await page.getByRole('dialog').waitFor();
      await check('study-invalid');
      await page.keyboard.press('Escape');

      await page.goto(`/trials/${study.trial}`);
      await page.locator('[data-part="depth-curve"]').waitFor();
      await page.locator('[data-panel="turn"] canvas').waitFor();
      await page.waitForLoadState('networkidle');
      await page.waitForTimeout(500);
      await check('trial-probing');
    }
    await page.goto('/studies/new');
    await page.getByLabel('Title').fill('Spine study');
    await page.getByLabel(/One a line/).fill('P01, resident, 0.5\nDr Who');
    await check('study-new');

    await page.goto('/nowhere');
    await page.getByRole('heading', { name: 'There is no such page' }).waitFor();
    await check('not-found');

    expect(faults).toEqual([]);
    await context.close();
  }, 180_000);
});
