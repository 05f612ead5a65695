/** Pages in German and French, as a browser set to them gets them: said in the language, without faults, not wider than the screen. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { asked, kShots, launch, someStudy } from './browser';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());

/** A SIMULATED station as its program describes itself (station/kiosk/machine.cpp). */
const kStation = { screen: 'badge', simulated: true, name: '', notice: '', waiting_trials: 2, technician: true };
const kScreens: Readonly<Record<string, object>> = {
  badge: kStation,
  pin: { ...kStation, screen: 'pin', name: 'Ada', notice: 'The PIN is wrong.' },
  work: {
    ...kStation,
    screen: 'work',
    name: 'Ada',
    work: { assignment: 'a-1', name: 'Fall A', number: 3, planned: 12, left: 10, rig: 'palpation', tool: 'probe' },
  },
  answer: { ...kStation, screen: 'answer', name: 'Ada', question: { rig: 'palpation', length_m: 0.04 } },
  fault: {
    ...kStation,
    screen: 'fault',
    fault: { kind: 'emergency_stop', what: '', signed_in: false },
  },
};

async function open(locale: string, width: number): Promise<{ page: Page; faults: string[] }> {
  const context = await browser.newContext({
    locale,
    viewport: { width, height: width < 600 ? 844 : 900 },
    baseURL: inject('url'),
  });
  const page = await context.newPage();
  const faults: string[] = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  page.on('console', (line) => {
    if (line.type() === 'error' && !/40[14]|WebSocket/.test(line.text())) faults.push(line.text());
  });
  return { page, faults };
}

/** A SIMULATED person who has passed, as the server answers. */
const kPassed = {
  account_id: 't0',
  name: 'S01',
  curriculum_id: 'c1',
  title: 'Pedikelschrauben, 1. Jahr',
  version: 2,
  passed: true,
  passed_utc_us: Date.UTC(2026, 8, 30, 12) * 1000,
  simulated: true,
  next: null,
  steps: [
    {
      id: 'step-1',
      name: 'Lumbalwirbel',
      state: 'passed',
      done: 12,
      planned: 12,
      assignments: ['a-1'],
      rests_on: {
        trials: 12,
        first_utc_us: Date.UTC(2026, 8, 1, 12) * 1000,
        last_utc_us: Date.UTC(2026, 8, 29, 12) * 1000,
        digest: '0123456789abcdef0123',
      },
      passed: true,
      passed_at: 12,
      holds_now: true,
      trials: 12,
      requirements: [{ met: true, required: 'at least 80 % of answers correct', found: '11 of 12' }],
    },
  ],
};

/** Buttons whose words are wider than they are. */
const cut = (page: Page) =>
  page.evaluate(() =>
    [...document.querySelectorAll('button')]
      .filter((one) => one.scrollWidth > one.clientWidth + 1)
      .map((one) => one.textContent),
  );

const wider = (page: Page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

const kWords = {
  'de-CH': {
    lang: 'de',
    sign_in: 'Anmelden',
    badge: 'Scannen Sie Ihren Badge',
    breach: 'Wo ist eine Perforation?',
    compare: 'Vergleichen',
  },
  'fr-CH': {
    lang: 'fr',
    sign_in: 'Se connecter',
    badge: 'Scannez votre badge',
    breach: 'Où se trouve une effraction ?',
    compare: 'Comparer',
  },
} as const;

const places = [
  ['de-CH', 1440],
  ['fr-CH', 390],
] as const;

const kTraining = [
  '/assignments',
  '/assignments/new',
  '/trainees',
  '/trainees/S01',
  '/cases',
  '/curricula',
  '/certificates/t0/c1',
] as const;
const kTrials = [
  '/trials',
  '/trials/trial-001',
  '/trials/trial-001/debrief',
  '/ratings',
  '/ratings/rubrics',
  '/ratings/rubrics/new',
  '/ratings/agreement',
] as const;
const kOthers = [
  '/class',
  '/class/change',
  '/class/groups',
  '/account',
  '/account/notifications',
  '/account/tokens',
  '/network/tokens',
  '/network/mail',
  '/studies',
  '/studies/new',
] as const;
const kGuide = [
  '/guide',
  '/guide/trainee',
  '/guide/faculty',
  '/guide/director',
  '/guide/researcher',
  '/guide/technician',
  '/guide/admin',
  '/guide/first-week',
  '/guide/scripts',
] as const;
const kNetwork = [
  '/network/people',
  '/network/cohorts',
  '/network/stations',
  '/network/backups',
  '/network/retention',
  '/network/audit',
] as const;
const kAnalysis = ['/analysis', '/analysis/example', '/analysis/plans/new', '/lab', '/lab/versions'] as const;

describe.runIf(inject('fixture')).each(places)('in %s at %i px', (locale, width) => {
  const words = kWords[locale];
  const shot = (name: string) => `${kShots}language-${words.lang}-${name}-${String(width)}.png`;

  const signIn = async (page: Page) => {
    const { name, password } = inject('account');
    await page.locator('input[name="username"]').fill(name);
    await page.locator('input[name="password"]').fill(password);
    await page.getByRole('button', { name: words.sign_in }).click();
    await page.locator('nav').first().waitFor();
  };
  /** Addresses whose page is wider than the screen. */
  const tooWide = async (page: Page, addresses: readonly string[]) => {
    const found: string[] = [];
    for (const address of addresses) {
      await page.goto(address);
      await page.waitForLoadState('networkidle');
      const over = await wider(page);
      if (over > 0) found.push(`${address}: ${String(over)} px`);
      await page.screenshot({ path: shot(address.slice(1).replaceAll('/', '-')), fullPage: true });
    }
    return found;
  };

  it('the sign-in and the pages of assignments, cases and trainees are said in the language and fit', async () => {
    const { page, faults } = await open(locale, width);
    await page.route('**/api/v1/accounts/t0/curricula', (route) => route.fulfill({ json: { people: [kPassed] } }));
    await page.goto('/');
    await page.getByRole('heading', { name: words.sign_in }).waitFor();
    expect(await page.locator('html').getAttribute('lang')).toBe(words.lang);
    await page.screenshot({ path: shot('sign-in'), fullPage: true });
    await signIn(page);
    expect(await tooWide(page, kTraining)).toEqual([]);
    expect(faults).toEqual([]);
    await page.context().close();
  });

  it.each([
    ['trials and ratings', kTrials],
    ['classes, accounts and studies', kOthers],
    ['the guide', kGuide],
    ['accounts, cohorts, stations and backups', kNetwork],
    ['analyses and the lab', kAnalysis],
  ])('the pages of %s are said in the language and fit', async (_name, addresses) => {
    const { page, faults } = await open(locale, width);
    await page.goto('/');
    await signIn(page);
    expect(await tooWide(page, addresses)).toEqual([]);
    expect(faults).toEqual([]);
    await page.context().close();
  });

  it('the pages of one study, one station, a person who leaves and the lab’s steps are said in the language and fit', async () => {
    const { page, faults } = await open(locale, width);
    await page.goto('/lab');
    await signIn(page);
    const study = await someStudy(page);
    const { stations } = await asked<{ stations: { id: string }[] }>(page, '/stations');
    const { accounts } = await asked<{ accounts: { id: string }[] }>(page, '/accounts');
    await page.getByRole('button', { name: words.compare, exact: true }).click();
    await page.waitForURL(/\/lab\/work\//);
    const work = new URL(page.url()).pathname.split('/').slice(0, 5).join('/');
    const steps = ['compare', 'where', 'missing', 'add', 'publish'].map((step) => `${work}/${step}`);
    const own = [
      `/studies/${study?.id ?? ''}`,
      `/network/stations/${stations[0]?.id ?? ''}`,
      `/network/people/${accounts[0]?.id ?? ''}/leaving`,
    ];
    expect(await tooWide(page, [...own, ...steps])).toEqual([]);
    expect(faults).toEqual([]);
    await page.context().close();
  });

  // A station's screen is as wide as a tablet at least.
  it.runIf(width > 1000)('the kiosk is said in the language and fits', async () => {
    const { page, faults } = await open(locale, width);
    let shown: object = kStation;
    await page.routeWebSocket(/\/kiosk\/live/, (socket) => socket.send(JSON.stringify(shown)));
    const found: string[] = [];
    for (const [name, state] of Object.entries(kScreens)) {
      shown = state;
      await page.goto('/kiosk.html');
      await page.locator(`[data-screen="${name}"]`).waitFor();
      const over = await wider(page);
      if (over > 0) found.push(`${name}: ${String(over)} px`);
      found.push(...(await cut(page)).map((words) => `${name}: ${words}`));
      await page.screenshot({ path: shot(`kiosk-${name}`) });
      if (name === 'badge') await page.getByRole('heading', { name: words.badge }).waitFor();
      if (name === 'answer') await page.getByRole('heading', { name: words.breach }).waitFor();
    }
    expect(found).toEqual([]);
    expect(faults).toEqual([]);
    await page.context().close();
  });
});

it.runIf(inject('fixture'))('the language switch changes the page, keeps the focus and is remembered', async () => {
  const { page } = await open('en-GB', 1440);
  await page.goto('/');
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  await page.getByRole('button', { name: 'Français' }).click();
  await page.getByRole('heading', { name: 'Se connecter' }).waitFor();
  expect(await page.evaluate(() => document.activeElement?.textContent)).toBe('Français');
  await page.reload();
  await page.getByRole('heading', { name: 'Se connecter' }).waitFor();
  await page.getByRole('button', { name: 'English' }).click();
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  expect(await page.locator('html').getAttribute('lang')).toBe('en');
  await page.context().close();
});

it.runIf(inject('fixture'))(
  'the language of the account is spoken whatever the browser’s is, until sign-out',
  async () => {
    const { page } = await open('en-GB', 1440);
    const { name, password } = inject('account');
    await page.goto('/account');
    await page.getByLabel('Name').fill(name);
    await page.getByLabel('Password').fill(password);
    await page.getByRole('button', { name: 'Sign in' }).click();
    await page.getByRole('combobox', { name: 'Language' }).selectOption('Deutsch');
    await page.getByRole('heading', { name: 'Mein Konto' }).waitFor();
    await page.evaluate(() => localStorage.clear());
    await page.reload();
    await page.getByRole('heading', { name: 'Mein Konto' }).waitFor();
    await page.getByRole('button', { name: 'Français' }).click();
    await page.getByRole('heading', { name: 'Mon compte' }).waitFor();
    await page.evaluate(() => localStorage.clear());
    await page.reload();
    await page.getByRole('heading', { name: 'Mon compte' }).waitFor();
    await page.getByRole('button', { name: 'Se déconnecter' }).click();
    await page.getByRole('heading', { name: 'Sign in' }).waitFor();
    await page.context().close();
  },
);

it.runIf(inject('fixture'))('the kiosk speaks the language of who is signed in, then its own again', async () => {
  const { page } = await open('en-GB', 1440);
  let send: (state: object) => void = () => undefined;
  await page.routeWebSocket(/\/kiosk\/live/, (socket) => {
    send = (state) => socket.send(JSON.stringify(state));
    send(kStation);
  });
  await page.goto('/kiosk.html');
  await page.getByRole('heading', { name: 'Scan your badge' }).waitFor();
  send({ ...kScreens.work, language: 'de' });
  await page.getByRole('button', { name: 'Abmelden' }).waitFor();
  send(kStation);
  await page.getByRole('heading', { name: 'Scan your badge' }).waitFor();
  await page.context().close();
});

it.runIf(inject('fixture'))('a browser of another language gets English', async () => {
  const { page } = await open('rm-CH', 1440);
  await page.goto('/');
  await page.getByRole('heading', { name: 'Sign in' }).waitFor();
  expect(await page.locator('html').getAttribute('lang')).toBe('en');
  await page.context().close();
});
