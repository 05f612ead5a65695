/** Pictures of every page, for a person to look at, and axe-core's rules on each. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { asked, assessedTrial, jumped, launch, signIn, someStudy, visit } from './browser';
import { checker, kLooks, type Check } from './looks';

const kNoticed = 0.1;

/** The lab's pages, each as soon as it has all that it shows. */
async function lab(page: Page, check: Check): Promise<void> {
  await page.goto('/lab');
  await page.locator('fieldset input[type="radio"]').first().waitFor();
  await check('lab');
  await page.getByRole('button', { name: 'Compare' }).click();
  await page.locator('[data-panel="value"] canvas').waitFor();
  await page.waitForLoadState('networkidle');
  await page.waitForTimeout(500);
  await check('lab-compare');
  await page.getByRole('link', { name: 'Error regions' }).click();
  await page.locator('[data-part="regions"] tbody button').first().click();
  await page.locator('[data-part="intervals"]').waitFor();
  await page.waitForTimeout(500);
  await check('lab-where');
  await page.getByRole('link', { name: 'Missing effects' }).click();
  const find = page.getByRole('button', { name: 'Find missing effects' });
  const verdict = page.locator('[data-part="verdict"]');
  await find.or(verdict).first().waitFor(); // a visit before this one may have found it
  if (await find.isVisible()) {
    await check('lab-missing-before');
    await find.click();
    await page.locator('[data-part="run-state"]').waitFor();
    await check('lab-missing-running');
  }
  await verdict.waitFor({ timeout: 60_000 });
  await page.waitForLoadState('networkidle');
  await page.waitForTimeout(500);
  await check('lab-missing');
  await page.getByRole('link', { name: 'Add effects', exact: true }).click();
  await page.getByLabel('Custom formula').check();
  await page.getByLabel('Formula', { exact: true }).fill('c * (v_m_s + x_m)');
  await page.locator('[data-part="unit-check"]').filter({ hasText: 'm/s' }).waitFor();
  await check('lab-add');
  await page.getByRole('link', { name: 'Publish', exact: true }).click();
  await page.getByRole('heading', { name: /^Publish/ }).waitFor();
  await check('lab-publish');
  await page.goto('/lab/versions');
  await page.locator('[data-part="tree"]').waitFor();
  await check('lab-versions');
}

/** From the published example over a plan to its result. */
async function analysis(page: Page, check: Check): Promise<void> {
  await page.goto('/analysis/example');
  await page.getByText('Published and recomputed values').waitFor();
  await check('analysis-example');
  await page.goto('/analysis');
  await page.getByLabel('Formula (editable)').waitFor();
  await check('analysis');
  // Two cohorts beside one another in three clicks, where there are two.
  if ((await page.getByLabel('Compared with').count()) > 0) {
    await page.getByLabel('Cohort', { exact: true }).selectOption({ index: 1 });
    await page.getByLabel('Compared with').selectOption({ index: 0 });
    await page.getByRole('button', { name: 'Compare', exact: true }).click();
    await page.locator('[data-part="figures"] svg').first().waitFor();
    await check('analysis-compared');
    await page.goto('/analysis');
  }
  await page.getByRole('link', { name: 'New plan' }).click();
  await page.getByLabel('Title').fill('Does experience shorten the operation?');
  await page.getByLabel('Endpoint').first().selectOption('operation_time');
  await page.getByRole('button', { name: 'Add to plan' }).click();
  await check('analysis-plan-new');
  await page.getByRole('button', { name: 'Lock plan…' }).click();
  await page.getByRole('dialog').waitFor();
  await check('analysis-lock');
  await page.getByRole('button', { name: 'Lock plan', exact: true }).click();
  await page.getByRole('button', { name: 'Run on current trials' }).waitFor();
  await check('analysis-plan');
  await page.getByRole('button', { name: 'Run on current trials' }).click();
  await page.getByText('Methods text for publication').waitFor();
  await check('analysis-run');
}

/** Trainees and the network's pages, where there are people. */
async function programme(page: Page, check: Check): Promise<void> {
  await page.goto('/trainees');
  await page.locator('tbody a').first().waitFor();
  await check('trainees');
  await page.locator('tbody a').first().click();
  await page.getByRole('heading', { name: 'Competence' }).waitFor();
  await page.waitForLoadState('networkidle');
  await check('trainee');
  await page.goto('/cohorts');
  await page
    .getByRole('img', { name: /^Share of correct answers by running/ })
    .or(page.getByText(/There are no cohorts yet|No trainee has five/))
    .first()
    .waitFor();
  await check('cohorts');
  for (const place of ['people', 'cohorts', 'stations', 'backups', 'audit']) {
    await page.goto(`/network/${place}`);
    await page.locator('tbody tr').or(page.getByText('No backups yet.')).first().waitFor();
    await page.waitForLoadState('networkidle');
    await check(`network-${place}`);
  }
  await page.goto('/account/tokens');
  await page.getByRole('group', { name: /^Scopes/ }).waitFor();
  await check('account-tokens');
  await page.goto('/network/tokens');
  await page.getByRole('heading', { name: 'Valid tokens' }).waitFor();
  await check('network-tokens');
  await page.goto('/account/notifications');
  await page.getByRole('button', { name: 'Send a test' }).waitFor();
  await check('account-notifications');
  await page.goto('/network/mail');
  await page.getByRole('heading', { name: 'Deliveries' }).waitFor();
  await check('network-mail');
  await page.goto('/network/retention');
  await page.getByRole('heading', { name: 'Rules now' }).waitFor();
  await check('network-retention');
  await page.goto('/class/groups');
  await page.getByRole('button', { name: 'Add a line' }).click();
  await check('class-groups');
  await page.goto('/guide/scripts');
  await page.getByRole('heading', { name: 'curl' }).waitFor();
  await check('guide-scripts');
  await page.goto('/network/stations');
  await page.locator('tbody a').nth(2).click();
  await page.getByRole('heading', { name: 'Status' }).or(page.getByText('could not be loaded')).waitFor();
  await page.waitForLoadState('networkidle');
  await check('network-station');
  await page.goto('/wall');
  await page
    .locator('[data-station]')
    .or(page.getByText('No stations are enrolled yet.'))
    .or(page.locator('[data-connection="connecting"]'))
    .first()
    .waitFor();
  await page.waitForTimeout(300);
  await check('wall');
}

/** Has the server models and measurements to work on? The demonstration's has a trial alone. */
async function hasProgramme(page: Page): Promise<boolean> {
  const { measurements } = await asked<{ measurements: unknown[] }>(page, '/lab/measurements');
  return measurements.length > 0;
}

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

describe.each(kLooks)('at $width px, first dark: $dark', (look) => {
  it('every page can be used without sight, fits the screen and breaks no policy', async () => {
    const { context, page, faults } = await visit(browser, look);
    const looks = checker(page, look);
    const check: Check = async (name) => {
      await looks(name); // takes a while, in which what loads late would make the page jump
      const { layoutShift, layoutShiftOf } = await jumped(page);
      expect(layoutShift, `${name}: jumps: ${layoutShiftOf.join(', ')}`).toBeLessThan(kNoticed);
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
      await page.locator('tbody button[aria-expanded]').first().waitFor();
      await check('study');
      await page.locator('tbody button[aria-expanded]').first().click();
      await page
        .getByRole('button', { name: /^Mark as invalid: trial/ })
        .first()
        .click();
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
    await page.getByLabel(/One per line/).fill('P01, resident, 0.5\nDr Who');
    await check('study-new');

    if (await hasProgramme(page)) {
      await lab(page, check);
      await analysis(page, check);
      await programme(page, check);
    }
    await page.goto('/guide/researcher');
    await page.getByRole('heading', { name: 'Terms' }).waitFor();
    await check('guide');
    await page.goto('/account');
    await page.getByRole('button', { name: 'Change password' }).waitFor();
    await check('account');

    await page.goto('/nowhere');
    await page.getByRole('heading', { name: 'Page not found' }).waitFor();
    await check('not-found');

    expect(faults).toEqual([]);
    await context.close();
  }, 600_000);
});
