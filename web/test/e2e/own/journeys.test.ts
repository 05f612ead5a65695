/** Each role on a real server, from sign-in to what it came for. Set GUIDE_PICTURES=1 to keep the guide's pictures. */
import { writeFileSync } from 'node:fs';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { kShots, launch } from '../browser';
import { picture } from '../guide-pictures';
import { at, furnish, kTrainees, Person, scored, tuned, type Programme } from '../programme';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus-server', 'tractus-station', 'tractus');
const [kAda, kBen] = kTrainees;

describe.skipIf(bin === undefined)('on a real server', () => {
  let browser: Browser, served: Served, programme: Programme, assignment: string;
  const faults: string[] = [];
  beforeAll(async () => {
    served = await serveReal(bin ?? '');
    programme = await furnish(served, bin ?? '');
    const faculty = await new Person(served.url).in('faculty', programme.passwords.get('faculty') ?? '');
    const { cases } = await faculty.ask<{ cases: { id: string }[] }>('GET', '/cases');
    ({ id: assignment } = await faculty.ask<{ id: string }>('POST', '/assignments', {
      title: 'Four kinds of bone',
      cases: tuned,
      cohort: programme.cohort,
      repeats: 4,
      seed: 3,
      release: 'held',
    }));
    programme.does(kAda, 16);
    programme.does(kBen, 16);
    await faculty.ask('POST', '/assignments', {
      title: 'The wall of the tract',
      cases: [{ case: cases[0]?.id }],
      people: [kAda],
      release: 'at_once',
    });
    programme.does(kAda, 1, 'sim-lambda6');
    await scored(programme.admin);
    browser = await launch();
  }, 600_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
  });
  const enter = async (name: string) => {
    const page = await at(browser, served, name, programme.passwords.get(name) ?? '');
    page.on('pageerror', (error) => faults.push(`${name}: ${String(error)}`));
    return page;
  };

  it('a trainee sees nothing of the assignment before its results are released, and the own curve after', async () => {
    const page = await enter(kBen);
    expect(await page.getByRole('navigation', { name: 'Pages' }).getByRole('link').allInnerTexts()).not.toContain(
      'Studies',
    );
    await page.goto('/me');
    await page.getByText('No results yet.').waitFor();
    await programme.admin.ask('POST', `/assignments/${assignment}/release`, { release: 'released' });
    await page.reload();
    await page.getByText(/ of 16/).waitFor();
    expect(await page.getByText('Next case').count(), 'no scenario is named that may come').toBe(0);
    await picture(page, 'trainee');
    await page.goto('/trials');
    await page.locator('tbody a').first().click();
    await page.locator('[data-part="depth-curve"]').waitFor();
    await page.context().close();
  }, 120_000);

  it('a director finds who is on track and prints one page', async () => {
    const page = await enter('director');
    await page.goto('/trainees');
    await page.getByRole('link', { name: kAda }).waitFor();
    await picture(page, 'director');
    await page.getByRole('link', { name: kAda }).click();
    await page.getByRole('heading', { name: 'Competence' }).waitFor();
    await page.waitForLoadState('networkidle');
    const pdf = await page.pdf({ format: 'A4', printBackground: false });
    writeFileSync(`${kShots}trainee.pdf`, pdf);
    await page.emulateMedia({ media: 'print' });
    await page.setViewportSize({ width: 794, height: 1123 });
    await page.screenshot({ path: `${kShots}trainee-printed.png`, fullPage: true });
    const sheets = pdf.toString('latin1').match(/\/Type\s*\/Page[^s]/g)?.length ?? 0;
    expect(sheets, 'sheets of paper').toBe(1);
    await page.context().close();
  }, 120_000);

  it('prints one sheet and whole curves after a year too: 64 trials of nine scenarios', async () => {
    const page = await enter('director');
    await page.route('**/api/v1/cohort/trainees/*', async (route) => {
      const answer = await route.fetch();
      const one = (await answer.json()) as { attempts: object[]; scenarios: object[]; relapses: object[] };
      const again = <Row>(rows: readonly Row[], many: number) =>
        Array.from({ length: many }, (_, i) => rows[i % rows.length] as Row);
      await route.fulfill({
        json: {
          ...one,
          trials: 64,
          attempts: again(one.attempts, 64).map((attempt, i) => ({ ...attempt, number: i + 1 })),
          scenarios: again(one.scenarios, 9).map((row, i) => ({ ...row, scenario: `L3 left pedicle, whole ${i}` })),
          competent_at_trial: 30,
          relapses: [{ at_trial: 40, recovered_at_trial: 60 }],
        },
      });
    });
    await page.goto(`/trainees/${encodeURIComponent(kAda)}`);
    await page.getByRole('heading', { name: 'Competence' }).waitFor();
    await page.waitForLoadState('networkidle');
    const pdf = await page.pdf({ format: 'A4' });
    expect(pdf.toString('latin1').match(/\/Type\s*\/Page[^s]/g)?.length, 'sheets of paper').toBe(1);
    await page.emulateMedia({ media: 'print' });
    await page.setViewportSize({ width: 688, height: 1017 });
    const outside = await page.evaluate(() =>
      [...document.querySelectorAll('figure')].flatMap((figure) => {
        const end = figure.getBoundingClientRect().right;
        return [...figure.querySelectorAll('svg circle, svg text')]
          .filter((mark) => mark.getBoundingClientRect().right > end + 1)
          .map((mark) => mark.textContent || mark.tagName);
      }),
    );
    expect(outside, 'marks beyond the edge of their chart').toEqual([]);
    await page.context().close();
  }, 120_000);

  it('a director sees how the cohort learns and who came last', async () => {
    const page = await enter('director');
    await page.goto('/trainees');
    await page.getByRole('link', { name: 'Cohorts', exact: true }).click();
    await page.getByRole('img', { name: /^Share of correct answers by running trial number/ }).waitFor();
    for (const name of [kAda, kBen]) await page.getByRole('link', { name }).waitFor();
    expect(await page.getByText('behind', { exact: true }).count(), 'two of sixteen trials each').toBe(0);
    await page.goto('/analysis');
    await page.getByText('Two cohorts with scored trials are needed.').waitFor();
    await page.context().close();
  }, 60_000);

  it('a member of the faculty opens a palpation trial of the own cohort', async () => {
    const page = await enter('faculty');
    await page.goto('/trials');
    await page.locator('tbody a').first().waitFor();
    const { trials } = await page.evaluate(
      async () =>
        (await fetch('/api/v1/trials?limit=50')).json() as Promise<{ trials: { id: string; case_title: string }[] }>,
    );
    const palpated = trials.find(({ case_title }) => case_title === 'L3 left pedicle');
    await page.goto(`/trials/${palpated?.id ?? ''}`);
    await page.locator('[data-part="scene"][data-ready]').waitFor();
    await page.locator('[data-panel="force"] canvas').waitFor();
    await picture(page, 'faculty');
    await page.context().close();
  }, 120_000);

  it('a researcher locks a plan, runs it and reads the result', async () => {
    const page = await enter('researcher');
    await page.goto('/analysis');
    await page.getByRole('link', { name: 'New plan' }).click();
    await page.getByLabel('Title').fill('Does practice shorten the operation?');
    await page.getByLabel('Endpoint').first().selectOption('operation_time');
    await page.getByRole('button', { name: 'Add to plan' }).click();
    await page.getByRole('button', { name: 'Lock plan…' }).click();
    await page.getByRole('button', { name: 'Lock plan', exact: true }).click();
    await page.getByRole('button', { name: 'Run on current trials' }).click();
    await page.getByText('Methods text for publication').waitFor({ timeout: 60_000 });
    await page.context().close();
  }, 120_000);

  it('a technician enrols a station by its code, revokes it, creates a backup and verifies it', async () => {
    const page = await enter('technician');
    await page.goto('/network/stations');
    await page.getByLabel('Name of the station').fill('theatre 4');
    await page.getByRole('button', { name: 'Create code' }).click();
    const code = await page.locator('[data-part="secret"]').innerText();
    const { execFileSync } = await import('node:child_process');
    execFileSync(`${bin ?? ''}/tractus-station`, [
      'enrol',
      '--server',
      served.url,
      '--code',
      code.trim(),
      '--token-file',
      `${served.folder}/theatre.token`,
    ]);
    await page.reload();
    await page.getByRole('link', { name: 'theatre 4' }).click();
    await page
      .getByRole('heading', { name: 'Status' })
      .or(page.getByText('The station could not be loaded.'))
      .waitFor();
    await page.goto('/network/stations');
    await page.getByRole('button', { name: 'Revoke theatre 4' }).click();
    await page.getByRole('button', { name: 'Revoke', exact: true }).click();
    await page
      .getByRole('row', { name: /theatre 4/ })
      .getByText('revoked')
      .waitFor();

    await page.goto('/network/backups');
    await page.getByText('No backups yet.').waitFor();
    await page.getByRole('button', { name: 'Create backup' }).click();
    await page.getByText('complete', { exact: true }).waitFor({ timeout: 60_000 });
    await page.getByRole('button', { name: /^Verify/ }).click();
    await page.getByText('passed', { exact: true }).waitFor({ timeout: 90_000 });
    await picture(page, 'technician');
    await page.context().close();
  }, 240_000);

  it('an administrator creates an account that has to choose its own password, and verifies the audit trail', async () => {
    const page = await at(browser, served, served.account.name, served.account.password);
    await page.goto('/network/people');
    await page.getByLabel('Name', { exact: true }).fill('newcomer');
    await page.getByRole('button', { name: 'Create account' }).click();
    const first = await page.locator('[data-part="secret"]').innerText();
    await picture(page, 'admin');
    const fresh = await at(browser, served, 'newcomer', first.trim());
    await fresh.getByLabel('Current password').fill(first.trim());
    await fresh.getByLabel('New password', { exact: true }).fill('a password of my own');
    await fresh.getByLabel('Repeat new password').fill('a password of my own');
    await fresh.getByRole('button', { name: 'Change password' }).click();
    await fresh.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name: 'My progress' }).click();
    await fresh.getByText('No results yet.').waitFor();
    await fresh.context().close();
    await page.goto('/network/audit');
    await page.getByRole('button', { name: 'Verify the audit trail' }).click();
    await page.getByText(/^The audit trail is intact/).waitFor();
    expect(await page.getByRole('row', { name: /Add account/ }).count()).toBeGreaterThan(0);
    await page.context().close();
    expect(faults).toEqual([]);
  }, 120_000);
});
