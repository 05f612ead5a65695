/** Pictures of the pages of teaching: cases, assignments, debrief, scenarios; and axe-core's rules on each. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { asked, assessedTrial, launch, signIn, visit } from './browser';
import { checker, kLooks, type Check } from './looks';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

async function still(page: Page): Promise<void> {
  await page.waitForLoadState('networkidle');
  await page.waitForTimeout(600);
}

async function cases(page: Page, check: Check, volume: string): Promise<void> {
  await page.goto('/cases');
  await page.locator('tbody a').first().waitFor();
  await check('cases');
  await page.goto(`/cases/new/${volume}`);
  await page.locator('[data-plane="axial"][data-ready]').waitFor();
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  await still(page);
  await check('case-new-empty');
  for (const [end, plane, x, y] of [
    ['Entry', 'axial', 0.5, 0.75],
    ['Target', 'axial', 0.48, 0.4],
  ] as const) {
    await page.getByRole('radio', { name: end }).check();
    const box = await page.locator(`[data-plane="${plane}"] svg`).boundingBox();
    if (!box) throw new Error('no slice');
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
  }
  await page.getByLabel('Breach', { exact: true }).selectOption('medial');
  await page.locator('[data-part="breach"]').waitFor();
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  await still(page);
  await check('case-new-full');
  await page.getByLabel('Channel', { exact: true }).selectOption('trainee drills');
  await page.getByText('No channel is pre-drilled').waitFor();
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  await still(page);
  await check('case-new-whole');
  await page.goto('/cases');
  await page.locator('tbody a[href^="/cases/"]:not([href^="/cases/new"])').first().click();
  await page.getByRole('button', { name: 'Show the breached wall' }).click();
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  await still(page);
  await check('case');
}

async function assigning(page: Page, check: Check): Promise<void> {
  await page.goto('/assignments');
  await page.locator('tbody a').first().waitFor();
  await check('assignments');
  await page.goto('/assignments/new');
  await page.getByRole('checkbox').first().waitFor();
  await page.getByRole('checkbox').first().check();
  await page.getByLabel('Title, shown to trainees').fill('Week 13');
  await still(page);
  await check('assignment-new');
  await page.goto('/assignments');
  await page.locator('tbody a').first().click();
  await page.locator('[data-part="results"]').waitFor();
  await still(page);
  await check('assignment');
}

async function debriefing(page: Page, check: Check): Promise<void> {
  await page.goto(`/trials/${await assessedTrial(page)}/debrief`);
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  await page.getByLabel('Example trial').selectOption({ index: 1 });
  await page.getByLabel('Time in the trial').fill('12');
  await page
    .getByLabel('Comment', { exact: true })
    .fill('Here you felt the wall and went on. Stay with it for a second before you push.');
  await page.getByRole('button', { name: 'Add comment' }).click();
  await page.locator('[data-part="comments"] li').first().waitFor();
  await page.locator('[data-part="scene"][data-ready]').waitFor();
  await still(page);
  await check('debrief');
}

async function scenarios(page: Page, check: Check): Promise<void> {
  await page.goto('/scenarios');
  await page
    .getByRole('link', { name: /lateral/ })
    .first()
    .waitFor();
  await check('scenarios');
  await page.goto('/scenarios/lateral_breach');
  await page.locator('[data-part="resistance"] path').first().waitFor();
  await still(page);
  await check('scenario');
  await page.getByLabel('Stiffness K').fill('-1');
  await page.locator('[aria-invalid="true"]').first().waitFor();
  await still(page);
  await check('scenario-wrong');
}

describe.each(kLooks)('at $width px, first dark: $dark', (look) => {
  it('the pages of teaching can be used without sight, fit the screen and break no policy', async () => {
    const { context, page, faults } = await visit(browser, look);
    page.setDefaultTimeout(90_000);
    const check = checker(page, look, 'teaching-');
    await signIn(page);
    const { volumes } = await asked<{ volumes: { id: string; state: string }[] }>(page, '/volumes');
    const volume = volumes.find(({ state }) => state === 'released');
    if (volume) await cases(page, check, volume.id);
    if (volume) await assigning(page, check);
    if (volume) await debriefing(page, check);
    if (volume) await scenarios(page, check);
    expect(faults).toEqual([]);
    await page.route('**/api/v1/{cases,assignments,volumes,case-makings}*', (route) =>
      route.fulfill({ status: 500, contentType: 'application/json', body: '{"error":"the disk is full","code":"io"}' }),
    );
    for (const place of ['cases', 'assignments']) {
      await page.goto(`/${place}`);
      await page.getByRole('alert').first().waitFor();
      await check(`${place}-failing`);
    }
    await context.close();
  }, 600_000);
});
