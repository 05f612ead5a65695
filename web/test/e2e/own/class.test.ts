/**
 * A programme's first days on a real server: a class is imported from a spreadsheet, cards print, a curriculum with criteria is given to it,
 * SIMULATED hands do its trials at a station, steps open in order, one trainee passes and the certificate prints on one sheet.
 */
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { accessibilityFaults } from '../axe';
import { kShots, launch } from '../browser';
import { at, Person, scored } from '../programme';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus-server', 'tractus-station');
const kPin = '2580';
const kList = `Full name;PGY;Badge number;PIN
"Simulated Berg, Ida";1;501;${kPin}
Simulated Nord;;502;${kPin}
`;

async function look(page: Page, name: string): Promise<void> {
  for (const width of [1440, 820, 390]) {
    await page.setViewportSize({ width, height: 900 });
    const over = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
    await page.screenshot({ path: `${kShots}class-${name}-${String(width)}.png`, fullPage: true });
    expect(over, `${name} at ${String(width)} px`).toBeLessThanOrEqual(0);
    expect(await accessibilityFaults(page), `${name} at ${String(width)} px`).toEqual([]);
  }
  await page.setViewportSize({ width: 1440, height: 900 });
}

const sheets = async (page: Page) =>
  (await page.pdf({ format: 'A4' })).toString('latin1').match(/\/Type\s*\/Page[^s]/g)?.length ?? 0;

describe.skipIf(bin === undefined)('the first days of a programme', () => {
  let browser: Browser, served: Served, admin: Page, link: string;
  const run = (...words: string[]) =>
    execFileSync(join(bin ?? '', 'tractus-station'), words, { encoding: 'utf8', timeout: 120_000 });

  beforeAll(async () => {
    browser = await launch();
    served = await serveReal(bin ?? '');
    admin = await at(browser, served, served.account.name, served.account.password);
  }, 120_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
  });

  it('imports a class from a spreadsheet, with an error by its row first, and prints cards', async () => {
    await admin.goto('/class');
    await admin.getByLabel('Cohort', { exact: true }).selectOption('a new cohort…');
    await admin.getByLabel('Name of the new cohort').fill('Residents 2027');
    await admin.getByLabel('Level for rows without one (optional)').fill('PGY-2');
    const list = admin.getByLabel('Or paste the list; the first line names the columns');
    await list.fill(kList.replace(kPin, '12'));
    await admin.getByText('PIN: 4 to 12 digits are expected').or(admin.getByText('4 to 12 digits')).first().waitFor();
    expect(await admin.getByRole('button', { name: 'Create 2 accounts' }).isDisabled()).toBe(true);
    await look(admin, 'errors');
    await list.fill(kList);
    await admin.getByText('2 rows, no errors').waitFor();
    await look(admin, 'preview');
    await admin.getByRole('button', { name: 'Create 2 accounts' }).click();
    await admin.locator('[data-part="cards"] li').nth(1).waitFor();
    await look(admin, 'cards');
    expect(await sheets(admin)).toBe(1);
    const passwords = await admin.locator('[data-part="cards"] dd').allTextContents();
    link = `${served.url}/#card=${encodeURIComponent('Simulated Berg, Ida')}:${passwords[1] ?? ''}`;
  }, 120_000);

  it('signs a resident in by the card, whose password leaves the address', async () => {
    const context = await browser.newContext({ viewport: { width: 390, height: 800 } });
    const page = await context.newPage();
    await page.goto(link);
    expect(await page.getByLabel('Name').inputValue()).toBe('Simulated Berg, Ida');
    await page.waitForURL((url) => !url.hash.includes('card'), { timeout: 5000 });
    await page.getByRole('button', { name: 'Sign in' }).click();
    await page.getByText('Choose a new password').or(page.getByLabel('New password')).first().waitFor();
    await context.close();
  });

  it('changes many accounts at once, and asks before it makes an administrator', async () => {
    await admin.goto('/class/change');
    await admin.getByLabel('Simulated Nord').check();
    await admin.getByRole('button', { name: 'Set level…' }).click();
    await admin.getByLabel('Level (empty: none)').fill('PGY-3');
    await admin.getByRole('button', { name: 'Change', exact: true }).click();
    await admin.getByText('1 account was changed.').waitFor();
    await admin.getByRole('cell', { name: 'PGY-3' }).waitFor();
    await look(admin, 'change');
    await admin.goto('/network/people');
    await admin.getByLabel('Name', { exact: true }).fill('Second admin');
    await admin.getByRole('region', { name: 'New account' }).getByLabel('Role', { exact: true }).selectOption('admin');
    await admin.getByRole('button', { name: 'Create account' }).click();
    await admin.getByRole('heading', { name: 'Make Second admin an administrator?' }).waitFor();
    await admin.getByRole('button', { name: 'Cancel' }).click();
    expect(await admin.getByRole('cell', { name: 'Second admin' }).count()).toBe(0);
  });

  it('makes a curriculum of two steps, and gives it to the class', async () => {
    await admin.goto('/curricula/new');
    await admin.getByLabel('Title', { exact: true }).fill('Pedicle screws, year 1');
    await admin.getByLabel('Name, shown to trainees').fill('Hard bone');
    await admin.getByRole('group', { name: 'Cases' }).getByLabel(/Hard/).check();
    await admin.getByLabel('Correct answers at least, %').fill('1');
    await admin.getByRole('button', { name: 'Add a step' }).click();
    await admin.getByLabel('Name, shown to trainees').nth(1).fill('Soft bone');
    await admin.getByRole('group', { name: 'Cases' }).nth(1).getByLabel(/Soft/).check();
    await admin.getByLabel('Correct answers at least, %').nth(1).fill('1');
    await admin.getByRole('button', { name: 'Add: Bound on a metric' }).nth(1).click();
    await admin.getByLabel('Metric').selectOption('Probing time');
    await admin.getByLabel('Bound, s').fill('600');
    await admin.getByLabel('Trials that must meet it').fill('1');
    await look(admin, 'curriculum-editor');
    await admin.getByRole('button', { name: 'Make the curriculum' }).click();
    await admin.getByRole('heading', { name: 'Pedicle screws, year 1' }).waitFor();
    await admin.getByLabel('Cohort', { exact: true }).selectOption('Residents 2027');
    await admin.getByRole('button', { name: 'Give', exact: true }).click();
    await admin.getByText('Given to the cohort.').waitFor();
    await admin.getByRole('link', { name: 'Simulated Nord' }).waitFor();
    await look(admin, 'curriculum');
  }, 120_000);

  it('opens the second step when the first is passed, and certifies on one sheet', async () => {
    const person = await new Person(served.url).in(served.account.name, served.account.password);
    const { code } = await person.ask<{ code: string }>('POST', '/stations/codes', { name: 'skills lab' });
    const folder = join(served.folder, 'station'),
      token = join(served.folder, 'station.token'),
      pin = join(served.folder, 'pin');
    mkdirSync(folder);
    writeFileSync(pin, `${kPin}\n`);
    writeFileSync(join(folder, 'config.json'), JSON.stringify({ format: 'tractus-station/1', name: 'skills lab' }));
    run('enrol', '--server', served.url, '--code', code, '--token-file', token);
    const work = (seed: number) => {
      run(
        ...['assigned', '--badge', '502', '--pin-file', pin, '--data', folder, '--server', served.url],
        ...['--token-file', token, '--device', 'sim-rig', '--speed', 'fast', '--skill', '1', '--seed', String(seed)],
        ...['--trials', '1', '--json'],
      );
    };
    for (let trial = 0; trial < 6; ++trial) {
      work(trial + 1);
      await scored(person);
    }
    await admin.reload();
    await admin.getByRole('link', { name: /^passed/ }).waitFor();
    await look(admin, 'progress');
    await admin.getByRole('link', { name: /^passed/ }).click();
    await admin.locator('[data-part="certificate"]').waitFor();
    await admin.getByText('Some of these trials were done by a simulated hand.').waitFor();
    await look(admin, 'certificate');
    expect(await sheets(admin)).toBe(1);
  }, 240_000);

  it('states criteria of the programme with its own failure rates, in versions', async () => {
    await admin.goto('/criteria');
    await admin.getByText('Default criteria, where none are set:').waitFor();
    await admin.getByLabel('Of', { exact: true }).selectOption('Whole programme');
    await admin.getByRole('button', { name: 'Remove requirement 1' }).click();
    await admin.getByRole('button', { name: 'Add: Competence by LC-CUSUM' }).click();
    await admin.getByLabel('Unacceptable failure rate, %').fill('30');
    await admin.getByRole('button', { name: 'Store as a new version' }).click();
    await admin.getByText('failure rate 10 % acceptable, 30 % unacceptable').waitFor();
    await admin.getByRole('button', { name: 'Add: Bound on a metric' }).click();
    await admin.getByLabel('Metric').selectOption('Probing time');
    await admin.getByRole('button', { name: 'Take the bound from experts’ trials…' }).click();
    await admin.getByLabel('Experts').selectOption('Residents 2027');
    await admin.getByRole('button', { name: /^Use .* as the bound$/ }).waitFor();
    await look(admin, 'criteria');
    await admin.goto('/trainees');
    await admin.getByText('30 %').first().waitFor();
  }, 120_000);
});
