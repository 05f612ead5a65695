/**
 * A residency's first week on a real server, from the list of residents to the certificate, with two kiosks of which one loses the network
 * and one is killed. Each step is a picture; GUIDE_PICTURES=1 keeps them for the page "First week" of the guide. All hands are SIMULATED.
 */
import { writeFileSync } from 'node:fs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { kShots, launch } from '../browser';
import { picture } from '../guide-pictures';
import { KioskPerson } from '../kiosk-person';
import { startKiosk } from '../kiosk-station';
import { at, kTrainees, scored } from '../programme';
import { programs, serveReal, type Served } from '../real-server';
import { furnishResidency, kClass, kClassList, kExperts, kPin, kResidents, type Residency } from '../residency';

const bin = programs('tractus-server', 'tractus-station', 'tractus') ?? '';
const [abel, berg, ...others] = kClass as unknown as [Member, Member, ...Member[]];
const [kAda] = kTrainees;
const kAcceptable = 0.1,
  kUnacceptable = 0.4;

interface Member {
  readonly name: string;
  readonly badge: string;
}
interface Progress {
  readonly people: readonly { name: string; passed: boolean; steps: readonly { state: string }[] }[];
}
interface Standing {
  readonly rule: { readonly threshold: number };
  readonly state: string;
  readonly competent_at_trial: number | null;
  readonly relapses: readonly { at_trial: number; recovered_at_trial: number | null }[];
}

const sheets = async (page: Page, name: string) => {
  const pdf = await page.pdf({ format: 'A4' });
  writeFileSync(`${kShots}${name}.pdf`, pdf);
  return pdf.toString('latin1').match(/\/Type\s*\/Page[^s]/g)?.length ?? 0;
};

describe.skipIf(bin === '')('the first week of a residency', () => {
  let browser: Browser, served: Served, residency: Residency, director: Page, faculty: Page, curriculum: string;

  const ask = <Answer>(method: string, path: string, body?: unknown) =>
    residency.programme.admin.ask<Answer>(method, path, body);
  const progressOf = async ({ name }: Member) => {
    const { people } = await ask<Progress>('GET', `/curricula/${curriculum}/progress`);
    return people.find((one) => one.name === name);
  };
  const kiosk = async (number: 0 | 1, ...words: string[]) => {
    const { programme, line } = residency.kiosks[number] as Residency['kiosks'][number];
    const started = await startKiosk(bin, line, programme, ['--device', 'sim-rig', ...words]);
    return { ...started, line, person: await KioskPerson.before(browser, started.address) };
  };

  beforeAll(async () => {
    browser = await launch();
    served = await serveReal(bin);
    residency = await furnishResidency(served, bin);
    const { passwords } = residency.programme;
    director = await at(browser, served, 'director', passwords.get('director') ?? '');
    faculty = await at(browser, served, 'faculty', passwords.get('faculty') ?? '');
  }, 300_000);
  afterAll(async () => {
    await browser.close();
    for (const { line } of residency.kiosks) await line.cut();
    await served.stop();
  });

  it('a director imports 24 residents from a spreadsheet and prints their cards', async () => {
    await director.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name: 'Class' }).click();
    await director.getByLabel('Cohort', { exact: true }).selectOption('a new cohort…');
    await director.getByLabel('Name of the new cohort').fill(kResidents);
    await director.getByLabel('Or paste the list; the first line names the columns').fill(kClassList);
    await director.getByText('24 rows, no errors').waitFor();
    await picture(director, 'week-import');
    await director.getByRole('button', { name: 'Create 24 accounts' }).click();
    await director.locator('[data-part="cards"] li').nth(23).waitFor({ timeout: 120_000 });
    await picture(director, 'week-cards', '[data-part="cards"]');
    expect(await sheets(director, 'week-cards'), 'ten cards on a sheet').toBe(3);
    const { cohorts } = await ask<{ cohorts: { id: string; name: string; trainees: number }[] }>('GET', '/cohorts');
    const made = cohorts.find(({ name }) => name === kResidents);
    expect(made?.trainees).toBe(24);
    await ask('POST', `/cohorts/${made?.id ?? ''}/people`, { name: 'faculty' });
    for (const { name } of kClass.slice(0, 4))
      await ask('POST', '/consents', { account: name, tier: 'metrics', basis: 'simulated: no person' });
  }, 180_000);

  it('states what passing is, with a bound from the trials of three experts, and gives the curriculum to the class', async () => {
    await director.goto('/criteria');
    await director.getByLabel('Of', { exact: true }).selectOption('Whole programme');
    await director.getByRole('button', { name: 'Remove requirement 1' }).click();
    await director.getByRole('button', { name: 'Add: Competence by LC-CUSUM' }).click();
    await director.getByLabel('Unacceptable failure rate, %').fill(String(100 * kUnacceptable));
    await director.getByRole('button', { name: 'Store as a new version' }).click();
    await director.getByText('failure rate 10 % acceptable, 40 % unacceptable').waitFor();

    await director.goto('/curricula/new');
    await director.getByLabel('Title', { exact: true }).fill('Pedicle screws, year 1');
    await director.getByLabel('Name, shown to trainees').fill('Hard bone');
    await director.getByRole('group', { name: 'Cases' }).getByLabel(/Hard/).check();
    await director.getByLabel('Planned trials of each case').fill('8');
    await director.getByLabel('Correct answers at least, %').fill('30');
    await director.getByRole('button', { name: 'Add: Bound on a metric' }).click();
    await director.getByLabel('Metric').selectOption('Probing time');
    await director.getByLabel('Trials that must meet it').fill('1');
    await director.getByRole('button', { name: 'Take the bound from experts’ trials…' }).click();
    await director.getByLabel('Experts', { exact: true }).selectOption(kExperts);
    const use = director.getByRole('button', { name: /^Use .* as the bound$/ });
    await use.waitFor();
    await director.getByText(/^3 experts:/).waitFor();
    await director.getByLabel('Experts', { exact: true }).evaluate((field) => field.setAttribute('data-picture', ''));
    await picture(director, 'week-bound', 'fieldset:has([data-picture])');
    await use.click();
    await director.getByRole('button', { name: 'Add a step' }).click();
    await director.getByLabel('Name, shown to trainees').nth(1).fill('A breach');
    await director
      .getByRole('group', { name: 'Cases' })
      .nth(1)
      .getByLabel(/Lateral breach/)
      .check();
    await director.getByLabel('Planned trials of each case').nth(1).fill('8');
    await director.getByLabel('Correct answers at least, %').nth(1).fill('30');
    await director.getByRole('button', { name: 'Make the curriculum' }).click();
    await director.getByRole('heading', { name: 'Pedicle screws, year 1' }).waitFor();
    curriculum = new URL(director.url()).pathname.split('/').at(-1) ?? '';
    await director.getByLabel('Cohort', { exact: true }).selectOption(kResidents);
    await director.getByRole('button', { name: 'Give', exact: true }).click();
    await director.getByText('Given to the cohort.').waitFor();
    await director.getByRole('link', { name: abel.name }).waitFor();
    await picture(director, 'week-curriculum');
  }, 120_000);

  it('a resident works on at a kiosk that loses the network', async () => {
    const { person, line, end } = await kiosk(0, '--seed', '7');
    await person.signIn(abel.badge, kPin);
    await picture(person.page, 'week-kiosk-work');
    await person.touch('Start');
    await person.screen('running');
    await line.cut();
    await person.page.waitForTimeout(2000);
    await picture(person.page, 'week-kiosk-running');
    await person.answer('No breach', /75/);
    await person.screen('result');
    await person.says('is safe at this station');
    await picture(person.page, 'week-kiosk-offline');
    await person.touch('Next trial');
    await person.fault('network');
    await line.mend();
    await person.touch('Try again');
    await person.screen('work');
    await person.says('Trial 2 of 8');
    await person.touch('Sign out');
    await person.screen('badge');
    await person.page.close();
    await end();
  }, 180_000);

  it('a resident goes on at a kiosk that was killed in the middle of a trial', async () => {
    const first = await kiosk(1, '--seed', '9');
    await first.person.signIn(berg.badge, kPin);
    await first.person.touch('Start');
    await first.person.screen('running');
    await first.person.page.waitForTimeout(2000);
    await first.end('SIGKILL');
    await first.person.fault('lost');
    await first.person.page.close();
    const { person, end } = await kiosk(1, '--seed', '21');
    await person.fault('interrupted');
    await picture(person.page, 'week-kiosk-interrupted');
    await person.signIn(berg.badge, kPin);
    await person.touch('Start');
    await person.answer('No breach', /75/);
    await person.screen('result');
    await person.says('The server has it.');
    await person.touch('Sign out');
    await person.screen('badge');
    await person.page.close();
    await end();
    const { trials } = await ask<{ trials: { person: string }[] }>('GET', '/trials?search=Berg');
    expect(trials, 'the torn trial and the whole one').toHaveLength(2);
  }, 240_000);

  it('faculty and director talk the trial through and rate it, blind to the name and to each other', async () => {
    await director.goto('/ratings/rubrics/new');
    await director.getByRole('button', { name: /global rating scale of OSATS/ }).click();
    await director.getByLabel('Title').fill('Global rating');
    await director.getByRole('button', { name: 'Store the rubric' }).click();
    await director.getByRole('link', { name: 'Global rating' }).waitFor();
    await scored(residency.programme.admin);
    const { trials } = await ask<{ trials: { id: string }[] }>('GET', '/trials?search=Abel');
    const debrief = `/trials/${trials[0]?.id ?? ''}/debrief`;
    await faculty.goto(debrief);
    await faculty.getByLabel('Comment', { exact: true }).fill('Even speed; the answer fits what the hand felt.');
    await faculty.getByRole('button', { name: 'Add comment' }).click();
    await faculty.getByText('Even speed').waitFor();
    await picture(faculty, 'week-debrief');
    const rate = async (page: Page, points: string) => {
      const card = page.getByRole('region', { name: 'Ratings' });
      await card.getByRole('button', { name: 'Rate this trial' }).click();
      for (const scale of await card.getByRole('form').getByRole('group').all())
        await scale.getByRole('radio', { name: points }).check();
      await card.getByRole('button', { name: 'Submit rating' }).scrollIntoViewIfNeeded();
      return card;
    };
    const asking = faculty.getByRole('region', { name: 'Ratings' });
    await asking.getByLabel(/hide the trainee’s name/).check();
    await asking.getByRole('button', { name: 'Have this trial rated' }).click();
    const card = await rate(faculty, '4');
    await picture(faculty, 'week-rating', '[aria-label="Global rating"]');
    await card.getByRole('button', { name: 'Submit rating' }).click();
    await card.getByText('rated by 1 of 2').waitFor();
    await director.goto(debrief);
    await director.getByText('name hidden').waitFor();
    expect(await director.locator('main').innerText(), 'whose trial it is').not.toContain('Abel');
    await (await rate(director, '3')).getByRole('button', { name: 'Submit rating' }).click();
    await director.getByRole('columnheader', { name: 'faculty' }).waitFor();
    await director.getByText(abel.name).first().waitFor();
  }, 120_000);

  it('one resident passes, and the certificate prints on one sheet', async () => {
    const { hand, programme } = residency;
    for (let trial = 0; trial < 16 && !(await progressOf(abel))?.passed; ++trial) {
      const inFirst = (await progressOf(abel))?.steps[0]?.state !== 'passed';
      hand(abel.badge, 1, '--skill', '0.9', '--seed', String(trial + 40), '--answer', inFirst ? 'none' : 'lateral');
      await scored(programme.admin);
    }
    await director.goto(`/curricula/${curriculum}`);
    await director.getByRole('link', { name: /^passed/ }).waitFor();
    await picture(director, 'week-progress');
    await director.getByRole('link', { name: /^passed/ }).click();
    const certificate = director.locator('[data-part="certificate"]');
    await certificate.getByText(abel.name).waitFor();
    await certificate.getByText('Some of these trials were done by a simulated hand.').waitFor();
    expect(await sheets(director, 'week-certificate')).toBe(1);
    await director.emulateMedia({ media: 'print' });
    await picture(director, 'week-certificate');
    await director.emulateMedia({ media: null });
  }, 240_000);

  it('one trainee relapses and recovers, dated on the chart', async () => {
    const { hand, programme } = residency;
    await ask('POST', '/assignments', {
      title: 'Weekly practice',
      people: [kAda],
      cases: [{ scenario: { tuned: 'lateral_breach' } }],
      repeats: 20,
      release: 'at_once',
    });
    const { rule } = await ask<Pick<Standing, 'rule'>>('GET', '/cohort/trainees');
    // LC-CUSUM (Biau 2008): a success adds ln((1 - p0)/(1 - p1)); CUSUM: a failure adds ln(p1/p0), a success subtracts the former.
    const success = Math.log((1 - kAcceptable) / (1 - kUnacceptable)),
      failure = Math.log(kUnacceptable / kAcceptable);
    const enough = Math.ceil(rule.threshold / success),
      back = Math.ceil(failure / success);
    hand('100', enough, '--answer', 'lateral');
    hand('100', 1, '--answer', 'none');
    hand('100', back, '--answer', 'lateral');
    await scored(programme.admin);
    const found = await ask<Standing>('GET', `/cohort/trainees/${encodeURIComponent(kAda)}`);
    expect(found.competent_at_trial).toBe(enough);
    expect(found.relapses).toEqual([{ at_trial: enough + 1, recovered_at_trial: enough + 1 + back }]);
    expect(found.state).toBe('competent');
    await director.goto(`/trainees/${encodeURIComponent(kAda)}`);
    await director.getByRole('img', { name: /Relapse is signalled at trial \d+ and has ended at trial/ }).waitFor();
    await picture(director, 'week-relapse', 'main h1');
    expect(await sheets(director, 'week-relapse')).toBe(1);
  }, 240_000);

  it('a director compares two cohorts', async () => {
    const { hand, programme } = residency;
    for (const [i, { badge }] of others.slice(0, 2).entries())
      hand(badge, 3, '--skill', String(0.2 + 0.1 * i), '--seed', String(300 + 10 * i));
    await scored(programme.admin);
    await director.goto('/cohorts');
    await director.getByRole('img', { name: /^Share of correct answers by running trial number/ }).waitFor();
    await picture(director, 'week-cohorts');
    await director.goto('/analysis');
    await director.getByLabel('Cohort', { exact: true }).selectOption(kResidents);
    await director.getByLabel('Compared with').selectOption(kExperts);
    await director.getByLabel('By', { exact: true }).selectOption('probing_time');
    await director.getByText(`${kResidents}: 4 persons`).waitFor();
    await director.getByRole('button', { name: 'Compare' }).click();
    await director.getByText('Hedges’ g').first().waitFor({ timeout: 60_000 });
    await picture(director, 'week-compare');
  }, 180_000);
});
