/** Ratings by people and volumes: rated, compared, uploaded; pictures of the pages and axe-core's rules on each. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { accessibilityFaults } from './axe';
import { forgetJumps, jumped, kShots, launch, signIn, visit } from './browser';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

type Check = (name: string) => Promise<void>;

/** The fixture remembers: each look rates another trial. */
async function rating(page: Page, check: Check, look: number): Promise<void> {
  await page.goto('/ratings');
  await page.locator('tbody a').first().waitFor();
  await check('ratings');
  await page.locator('tbody a').nth(look).click();
  const card = page.getByRole('region', { name: 'Ratings' });
  await card.getByRole('button', { name: 'Have this trial rated' }).click();
  await card.getByRole('button', { name: 'Rate this trial' }).click();
  const submit = card.getByRole('button', { name: 'Submit rating' });
  for (const [item, points] of [
    ['Respect for tissue', '4'],
    ['Time and motion', '3'],
    ['Flow and planning', '5'],
  ] as const) {
    expect(await submit.isDisabled()).toBe(true);
    await card.getByRole('group', { name: item }).getByRole('radio', { name: points }).check();
  }
  await check('rating-form');
  await submit.click();
  await card.getByRole('columnheader', { name: 'R. Second' }).waitFor();
  expect(await card.getByRole('row', { name: /Sum/ }).innerText()).toMatch(/12\s+9/);
  await forgetJumps(page); // the form goes by the person's own click, however late the answer comes
  await check('rating-given');
  await card.getByRole('button', { name: 'Supersede my rating…' }).click();
  await card.getByLabel('Reason to supersede your rating').fill('wrong line');
  await card.getByRole('button', { name: 'Supersede my rating', exact: true }).click();
  await card.getByText('Superseded ratings').waitFor();
}

async function section(page: Page, check: Check): Promise<void> {
  await page.goto('/trials/trial-002/debrief');
  const card = page.getByRole('region', { name: 'Breach of the cortex' });
  await card.getByText('class B: 1.4 mm beyond the cortex').waitFor();
  await card.getByRole('img', { name: /reaches 1.4.mm beyond the cortex/ }).waitFor();
  await card.scrollIntoViewIfNeeded();
  await check('breach-class');
}

async function rubrics(page: Page, check: Check, look: number): Promise<void> {
  await page.goto('/ratings/rubrics');
  await page.locator('tbody a').first().waitFor();
  await check('rubrics');
  await page.getByRole('link', { name: 'New rubric' }).click();
  await page.getByRole('button', { name: /global rating scale of OSATS/ }).click();
  expect(await page.getByRole('group', { name: /^Item \d/ }).count()).toBe(7);
  await page.getByLabel('Title').fill(`Our rating ${look}`);
  await check('rubric-new');
  await page.getByRole('button', { name: 'Store the rubric' }).click();
  await page.getByRole('link', { name: `Our rating ${look}` }).waitFor();
  await page.goto('/ratings/agreement');
  await page.locator('svg circle').first().waitFor();
  await check('agreement');
}

async function volumes(page: Page, check: Check): Promise<void> {
  await page.goto('/volumes');
  await page.locator('tbody a').first().waitFor();
  await check('volumes');
  await page.getByRole('link', { name: 'Thorax' }).click();
  const axial = page.locator('[data-plane="axial"]');
  for (const plane of ['axial', 'coronal', 'sagittal'])
    await page.locator(`[data-plane="${plane}"][data-ready]`).waitFor();
  expect(await axial.locator('[class*="letter"]').allInnerTexts()).toEqual(['R', 'L', 'A', 'P']);
  const box = await axial.locator('svg').boundingBox();
  if (!box) throw new Error('no slice');
  await page.mouse.click(box.x + box.width * 0.4, box.y + box.height * 0.5);
  await page.mouse.click(box.x + box.width * 0.6, box.y + box.height * 0.5);
  await page.getByText(/Ruler: \d+\.\d.mm/).waitFor();
  const release = page.getByRole('button', { name: 'Release for making cases' });
  expect(await release.isDisabled()).toBe(true);
  await page.getByRole('checkbox').check();
  expect(await release.isDisabled()).toBe(false);
  await check('volume');
  await page.getByLabel('Zoom').selectOption('4');
  const zoomed = await axial.locator('svg').boundingBox();
  expect((zoomed?.width ?? 0) / box.width).toBeCloseTo(4, 1);
}

async function fromPacs(page: Page, check: Check): Promise<void> {
  await page.goto('/volumes');
  const card = page.getByRole('region', { name: 'From a PACS' });
  const search = card.getByRole('button', { name: 'Search' });
  expect(await search.isDisabled()).toBe(true);
  await card.getByLabel('Patient’s id').fill('PID-4711');
  await search.click();
  await card.getByRole('button', { name: 'Show its series' }).click();
  await card.getByRole('button', { name: 'Choose series 3' }).waitFor();
  expect(await card.getByRole('row', { name: /bone 1\.0/ }).innerText()).toMatch(/CT\s+180\s+0\.49.mm\s+–\s+1\.00.mm/);
  await card.getByRole('button', { name: 'Choose series 2' }).click();
  await check('pacs');
  const begin = card.getByRole('button', { name: 'Import' });
  expect(await begin.isDisabled()).toBe(true);
  await card.getByLabel('Name, without a patient’s name').fill('L3');
  await begin.click();
  await card.getByText(/The server fetches the series: 90 files, 47\.3.MB/).waitFor();
  await card.getByRole('link', { name: 'Look at the volume' }).waitFor();
  await check('pacs-imported');
  await card.getByRole('link', { name: 'Look at the volume' }).click();
  await page.getByRole('region', { name: 'From a PACS' }).waitFor({ state: 'detached' });
  await page.goBack();
  await card.getByText('The series is imported and waits for review.').waitFor();
  await card.getByLabel('Patient’s id').fill('nobody');
  await search.click();
  await card.getByText('No study fits.').waitFor();
}

describe.skipIf(!inject('fixture')).each([
  { width: 1440, dark: false, look: 0 },
  { width: 820, dark: true, look: 1 },
  { width: 390, dark: false, look: 2 },
])('at $width px, dark: $dark', ({ width, dark, look }) => {
  it('the pages of ratings and volumes can be used without sight, fit the screen and do not jump', async () => {
    const { context, page, faults } = await visit(browser, { width, dark });
    const check: Check = async (name) => {
      await page.waitForLoadState('networkidle');
      await page.screenshot({ path: `${kShots}rating-${name}-${width}.png`, fullPage: true });
      expect(await accessibilityFaults(page), name).toEqual([]);
      const overflow = await page.evaluate(
        () => document.documentElement.scrollWidth - document.documentElement.clientWidth,
      );
      expect(overflow, `${name}: pixels wider than the screen`).toBeLessThanOrEqual(0);
      const { layoutShift, layoutShiftOf } = await jumped(page);
      expect(layoutShift, `${name}: ${layoutShiftOf.join(', ')}`).toBeLessThan(0.1);
    };
    await signIn(page);
    await rating(page, check, look);
    await section(page, check);
    await rubrics(page, check, look);
    await volumes(page, check);
    await fromPacs(page, check);
    expect(faults).toEqual([]);
    await context.close();
  }, 240_000);
});
