/**
 * A residency's first week on a real server, from the list of residents to the certificate, with two kiosks of which one loses the network
 * and one is killed; in English, then in German. Each step is a picture; GUIDE_PICTURES=1 keeps them for the page "First week" of the guide.
 * All hands are SIMULATED.
 */
import { writeFileSync } from 'node:fs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { kShots, launch } from '../browser';
import { picture as pictureOf } from '../guide-pictures';
import { KioskPerson } from '../kiosk-person';
import { startKiosk } from '../kiosk-station';
import { at, kTrainees, scored } from '../programme';
import { programs, serveReal, type Served } from '../real-server';
import { furnishResidency, kClass, kClassList, kExperts, kPin, kResidents, type Residency } from '../residency';
import { Words, type TestedLanguage } from '../words';

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

const kWeeks: readonly TestedLanguage[] = ['en', 'de'];

describe.skipIf(bin === '').each(kWeeks)('the first week of a residency, %s', (language) => {
  const words = new Words(language);
  const { said, like } = words;
  /** What the kiosk says of the place of a trial among the planned ones. */
  const trialOf = (number: number, planned: number) => {
    const left = '{left, plural, one {It is your last one today.} other {You have # trials to do.}}';
    const all = said(`Trial {number} of {planned}. ${left}`, { number, planned, left: 1 });
    return all.slice(0, all.indexOf('.') + 1);
  };
  const picture = (page: Page, name: string, from?: string) => pictureOf(page, name, from, language);
  let browser: Browser, served: Served, residency: Residency, director: Page, faculty: Page, curriculum: string;

  const ask = <Answer>(method: string, path: string, body?: unknown) =>
    residency.programme.admin.ask<Answer>(method, path, body);
  const progressOf = async ({ name }: Member) => {
    const { people } = await ask<Progress>('GET', `/curricula/${curriculum}/progress`);
    return people.find((one) => one.name === name);
  };
  const kiosk = async (number: 0 | 1, ...more: string[]) => {
    const { programme, line } = residency.kiosks[number] as Residency['kiosks'][number];
    const started = await startKiosk(bin, line, programme, ['--device', 'sim-rig', ...more]);
    return { ...started, line, person: await KioskPerson.before(browser, started.address, words) };
  };

  beforeAll(async () => {
    browser = await launch();
    served = await serveReal(bin);
    residency = await furnishResidency(served, bin);
    const { passwords } = residency.programme;
    director = await at(browser, served, 'director', passwords.get('director') ?? '', { words });
    faculty = await at(browser, served, 'faculty', passwords.get('faculty') ?? '', { words });
  }, 300_000);
  afterAll(async () => {
    await browser.close();
    for (const { line } of residency.kiosks) await line.cut();
    await served.stop();
  });

  it('a director imports 24 residents from a spreadsheet and prints their cards', async () => {
    await director
      .getByRole('navigation', { name: said('Pages') })
      .getByRole('link', { name: said('Class') })
      .click();
    await director.getByLabel(said('Cohort'), { exact: true }).selectOption(said('a new cohort…'));
    await director.getByLabel(said('Name of the new cohort')).fill(kResidents);
    await director.getByLabel(said('Or paste the list; the first line names the columns')).fill(kClassList);
    await director.getByText(said('{count, plural, one {# row} other {# rows}}, no errors', { count: 24 })).waitFor();
    await picture(director, 'week-import');
    await director
      .getByRole('button', { name: said('Create {count, plural, one {# account} other {# accounts}}', { count: 24 }) })
      .click();
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
    await director.getByLabel(said('Of'), { exact: true }).selectOption(said('Whole programme'));
    await director.getByRole('button', { name: said('Remove requirement {number}', { number: 1 }) }).click();
    await director.getByRole('button', { name: said('Add: {kind}', { kind: said('Competence by LC-CUSUM') }) }).click();
    await director.getByLabel(said('Unacceptable failure rate, %')).fill(String(100 * kUnacceptable));
    await director.getByRole('button', { name: said('Store as a new version') }).click();
    await director
      .getByText(
        said('Competence by LC-CUSUM: failure rate {adequate} % acceptable, {inadequate} % unacceptable', {
          adequate: 100 * kAcceptable,
          inadequate: 100 * kUnacceptable,
        }),
      )
      .waitFor();

    await director.goto('/curricula/new');
    await director.getByLabel(said('Title'), { exact: true }).fill('Pedicle screws, year 1');
    await director.getByLabel(said('Name, shown to trainees')).fill('Hard bone');
    await director
      .getByRole('group', { name: said('Cases') })
      .getByLabel(/Hard/)
      .check();
    await director.getByLabel(said('Planned trials of each case')).fill('8');
    await director.getByLabel(said('Correct answers at least, %')).fill('30');
    await director.getByRole('button', { name: said('Add: {kind}', { kind: said('Bound on a metric') }) }).click();
    await director.getByLabel(said('Metric')).selectOption(said('Probing time'));
    await director.getByLabel(said('Trials that must meet it')).fill('1');
    await director.getByRole('button', { name: said('Take the bound from experts’ trials…') }).click();
    await director.getByLabel(said('Experts'), { exact: true }).selectOption(kExperts);
    const use = director.getByRole('button', { name: like('Use {bound} as the bound') });
    await use.waitFor();
    await director
      .getByText(
        like(
          '{people, plural, one {One expert} other {# experts}}: trials of one person are alike, so that few people make an uncertain bound.',
          { people: 3 },
        ),
      )
      .waitFor();
    await director
      .getByLabel(said('Experts'), { exact: true })
      .evaluate((field) => field.setAttribute('data-picture', ''));
    await picture(director, 'week-bound', 'fieldset:has([data-picture])');
    await use.click();
    await director.getByRole('button', { name: said('Add a step') }).click();
    await director.getByLabel(said('Name, shown to trainees')).nth(1).fill('A breach');
    await director
      .getByRole('group', { name: said('Cases') })
      .nth(1)
      .getByLabel(/Lateral breach/)
      .check();
    await director.getByLabel(said('Planned trials of each case')).nth(1).fill('8');
    await director.getByLabel(said('Correct answers at least, %')).nth(1).fill('30');
    await director.getByRole('button', { name: said('Make the curriculum') }).click();
    await director.getByRole('heading', { name: 'Pedicle screws, year 1' }).waitFor();
    curriculum = new URL(director.url()).pathname.split('/').at(-1) ?? '';
    await director.getByLabel(said('Cohort'), { exact: true }).selectOption(kResidents);
    await director.getByRole('button', { name: said('Give'), exact: true }).click();
    await director.getByText(said('Given to the cohort.')).waitFor();
    await director.getByRole('link', { name: abel.name }).waitFor();
    await picture(director, 'week-curriculum');
  }, 120_000);

  it('a resident works on at a kiosk that loses the network', async () => {
    const { person, line, end } = await kiosk(0, '--seed', '7');
    await person.signIn(abel.badge, kPin);
    await picture(person.page, 'week-kiosk-work');
    await person.touch(said('Start'));
    await person.screen('running');
    await line.cut();
    await person.page.waitForTimeout(2000);
    await picture(person.page, 'week-kiosk-running');
    await person.answer(said('No breach'), /75/);
    await person.screen('result');
    await person.says(
      said('The server does not answer. The trial is safe at this station and is sent later by itself.'),
    );
    await picture(person.page, 'week-kiosk-offline');
    await person.touch(said('Next trial'));
    await person.fault('network');
    await line.mend();
    await person.touch(said('Try again'));
    await person.screen('work');
    await person.says(trialOf(2, 8));
    await person.touch(said('Sign out'));
    await person.screen('badge');
    await person.page.close();
    await end();
  }, 180_000);

  it('a resident goes on at a kiosk that was killed in the middle of a trial', async () => {
    const first = await kiosk(1, '--seed', '9');
    await first.person.signIn(berg.badge, kPin);
    await first.person.touch(said('Start'));
    await first.person.screen('running');
    await first.person.page.waitForTimeout(2000);
    await first.end('SIGKILL');
    await first.person.fault('lost');
    await first.person.page.close();
    const { person, end } = await kiosk(1, '--seed', '21');
    await person.fault('interrupted');
    await picture(person.page, 'week-kiosk-interrupted');
    await person.signIn(berg.badge, kPin);
    await person.touch(said('Start'));
    await person.answer(said('No breach'), /75/);
    await person.screen('result');
    await person.says(said('The server has it.'));
    await person.touch(said('Sign out'));
    await person.screen('badge');
    await person.page.close();
    await end();
    const { trials } = await ask<{ trials: { person: string }[] }>('GET', '/trials?search=Berg');
    expect(trials, 'the torn trial and the whole one').toHaveLength(2);
  }, 240_000);

  it('faculty and director talk the trial through and rate it, blind to the name and to each other', async () => {
    await director.goto('/ratings/rubrics/new');
    await director.getByRole('button', { name: said('Begin with the global rating scale of OSATS') }).click();
    await director.getByLabel(said('Title')).fill('Global rating');
    await director.getByRole('button', { name: said('Store the rubric') }).click();
    await director.getByRole('link', { name: 'Global rating' }).waitFor();
    await scored(residency.programme.admin);
    const { trials } = await ask<{ trials: { id: string }[] }>('GET', '/trials?search=Abel');
    const debrief = `/trials/${trials[0]?.id ?? ''}/debrief`;
    await faculty.goto(debrief);
    await faculty.getByLabel(said('Comment'), { exact: true }).fill('Even speed; the answer fits what the hand felt.');
    await faculty.getByRole('button', { name: said('Add comment') }).click();
    await faculty.getByText('Even speed').waitFor();
    await picture(faculty, 'week-debrief');
    const rate = async (page: Page, points: string) => {
      const card = page.getByRole('region', { name: said('Ratings') });
      await card.getByRole('button', { name: said('Rate this trial') }).click();
      for (const scale of await card.getByRole('form').getByRole('group').all())
        await scale.getByRole('radio', { name: points }).check();
      await card.getByRole('button', { name: said('Submit rating') }).scrollIntoViewIfNeeded();
      return card;
    };
    const asking = faculty.getByRole('region', { name: said('Ratings') });
    await asking.getByLabel(like('hide the trainee’s name until all have rated')).check();
    await asking.getByRole('button', { name: said('Have this trial rated') }).click();
    const card = await rate(faculty, '4');
    await picture(faculty, 'week-rating', '[aria-label="Global rating"]');
    await card.getByRole('button', { name: said('Submit rating') }).click();
    await card.getByText(said('rated by {submitted} of {raters}', { submitted: 1, raters: 2 })).waitFor();
    await director.goto(debrief);
    await director.getByText(said('name hidden')).waitFor();
    expect(await director.locator('main').innerText(), 'whose trial it is').not.toContain('Abel');
    await (await rate(director, '3')).getByRole('button', { name: said('Submit rating') }).click();
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
    await director.getByRole('link', { name: like('passed {date}') }).waitFor();
    await picture(director, 'week-progress');
    await director.getByRole('link', { name: like('passed {date}') }).click();
    const certificate = director.locator('[data-part="certificate"]');
    await certificate.getByText(abel.name).waitFor();
    await certificate.getByText(said('Some of these trials were done by a simulated hand.')).waitFor();
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
    await director
      .getByRole('img', { name: like('Relapse is signalled at trial {trial} and has ended at trial {end}.') })
      .waitFor();
    await picture(director, 'week-relapse', 'main h1');
    expect(await sheets(director, 'week-relapse')).toBe(1);
  }, 240_000);

  it('a director compares two cohorts', async () => {
    const { hand, programme } = residency;
    for (const [i, { badge }] of others.slice(0, 2).entries())
      hand(badge, 3, '--skill', String(0.2 + 0.1 * i), '--seed', String(300 + 10 * i));
    await scored(programme.admin);
    await director.goto('/cohorts');
    await director.getByRole('img', { name: like('Share of correct answers by running trial number.') }).waitFor();
    await picture(director, 'week-cohorts');
    await director.goto('/analysis');
    const compare = director.getByRole('region', { name: said('Compare cohorts') });
    await compare.getByLabel(said('Cohort'), { exact: true }).selectOption(kResidents);
    await compare.getByLabel(said('Compared with')).selectOption(kExperts);
    await compare.getByLabel(said('Endpoint'), { exact: true }).selectOption('probing_time');
    await director
      .getByText(like('{name}: {persons} persons, {trials} trials', { name: kResidents, persons: 4 }))
      .waitFor();
    await director.getByRole('button', { name: said('Compare') }).click();
    await director.getByText('Hedges’ g').first().waitFor({ timeout: 60_000 });
    await picture(director, 'week-compare');
  }, 180_000);
});
