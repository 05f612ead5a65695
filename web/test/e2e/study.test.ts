/** A study as who runs it uses it: made from the page, watched, paused, a trial marked. Needs the fixture, whose study goes on when told. */
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { asked, launch, signIn, someStudy, visit, type Visit } from './browser';
import { inked } from './pixels';

interface Told {
  participants: {
    name: string;
    state: string;
    done: number;
    planned: number;
    slots: { state: string; trials: { state: string; reason: string }[] }[];
  }[];
  state: string;
}

let browser: Browser;
let seen: Visit;
beforeAll(async () => {
  browser = await launch();
  seen = await visit(browser);
  await signIn(seen.page);
});
afterAll(() => browser.close());

const told = (page: Page, id: string) => asked<Told>(page, `/studies/${id}`);

it.runIf(inject('fixture'))(
  'a study is made from the page: tuned scenarios, one from a file, participants; what is wrong is said',
  async () => {
    const { page, faults } = seen;
    await page.goto('/studies');
    await page.getByRole('link', { name: 'New study' }).click();
    await page.getByLabel('Title').fill('Spine study 1');
    const button = page.getByRole('button', { name: 'Create study' });
    await page.getByLabel(/One per line/).fill('P01, resident, 0.5\nP 02');
    await page.getByText('“P 02” is not a valid pseudonym').first().waitFor();
    expect(await button.isDisabled()).toBe(true);
    await page.getByLabel(/One per line/).fill('P01, resident, 0.5\nP02, senior, 6');
    await page.getByLabel('In, out and in again').uncheck();
    const file = (name: string, text: string) => ({ name, mimeType: 'application/json', buffer: Buffer.from(text) });
    await page
      .getByLabel(/Custom scenarios/)
      .setInputFiles([
        file(
          'mine.json',
          JSON.stringify({ format: 'tractus-scenario/1', name: 'Mine', bone: { stiffness_N_per_m: -1 } }),
        ),
        file('other.json', '{"a":1}'),
      ]);
    await page.getByText('other.json: not a tractus-scenario/1 file.').waitFor();
    await button.click();
    await page.getByText('stiffness_N_per_m: -1 is outside').waitFor();
    await page.getByRole('button', { name: 'Remove mine.json' }).click();
    await button.click();
    await page.getByRole('heading', { level: 1, name: 'Spine study 1' }).waitFor();
    const { participants } = await told(page, 'spine-study-1');
    expect(participants.map(({ name, slots }) => `${name}: ${slots.length}`)).toEqual(['P01: 9', 'P02: 9']);
    expect(faults).toEqual([]);
  },
);

describe.runIf(inject('fixture'))('the page of a study', () => {
  const kId = 'twelve-trials';
  const rowOf = (page: Page, name: string) => page.getByRole('row', { name: new RegExp(`^${name} `) });
  const open = async (page: Page) => {
    await page.goto(`/studies/${kId}`);
    await rowOf(page, 'S08').waitFor();
  };

  it('follows what comes in, without a jump', async () => {
    const { page } = seen;
    await open(page);
    const done = rowOf(page, 'S08').locator('[data-part="done"]');
    expect(await done.innerText()).toBe('0 of 12');
    const place = await rowOf(page, 'S10').boundingBox();
    await page.evaluate(async (id) => fetch(`/api/v1/studies/${id}/bring/S08`), kId);
    await expect.poll(() => done.innerText(), { timeout: 6_000 }).toBe('1 of 12');
    expect((await rowOf(page, 'S10').boundingBox())?.y).toBe(place?.y);
    await page.getByText('uploaded a trial of S08').first().waitFor();
  });

  it('pauses the study and a participant after a question, and Escape leaves things as they are', async () => {
    const { page } = seen;
    await open(page);
    await page.getByRole('button', { name: 'Pause study' }).click();
    await page.getByRole('dialog').waitFor();
    await page.keyboard.press('Escape');
    await page.getByRole('dialog').waitFor({ state: 'detached' });
    expect((await told(page, kId)).state).toBe('running');
    await page.getByRole('button', { name: 'Pause study' }).click();
    await page.getByRole('dialog').getByRole('button', { name: 'Pause' }).click();
    await page.getByRole('button', { name: 'Resume', exact: true }).first().waitFor();
    expect((await told(page, kId)).state).toBe('paused');
    await page.getByRole('button', { name: 'Resume', exact: true }).first().click();
    await page.getByRole('dialog').getByRole('button', { name: 'Resume' }).click();
    await page.getByRole('button', { name: 'Pause study' }).waitFor();
    await page.getByRole('button', { name: 'Pause S09' }).click();
    await page.getByRole('dialog').getByRole('button', { name: 'Pause' }).click();
    await page.getByRole('button', { name: 'Resume S09' }).waitFor();
  });

  it('marks a trial as not counting with a reason; it stays and its place is repeated', async () => {
    const { page } = seen;
    await open(page);
    await page.getByRole('button', { name: 'S01', expanded: false }).click();
    await page.getByRole('button', { name: 'Mark as invalid: trial 2 of S01' }).click();
    const dialog = page.getByRole('dialog');
    const deed = dialog.getByRole('button', { name: 'Mark as invalid' });
    expect(await deed.isDisabled()).toBe(true);
    await dialog.getByLabel('Reason').fill('the cable came loose');
    await deed.click();
    await page.getByText('the cable came loose').first().waitFor();
    const [first] = (await told(page, kId)).participants;
    expect(first?.slots.length).toBe(13);
    expect(first?.slots[1]?.trials[0]).toMatchObject({ state: 'invalid', reason: 'the cable came loose' });
  });

  it('that does not exist, or a server that does not answer, is told', async () => {
    const { context, page } = await visit(browser);
    await signIn(page);
    await page.goto('/studies/nowhere');
    await page.getByText('Study not found.').waitFor();
    await open(page);
    await page.route('**/api/v1/studies/**', (route) => route.abort());
    await page.getByText('The study could not be refreshed.').waitFor({ timeout: 20_000 });
    await page.unroute('**/api/v1/studies/**');
    await page.getByText('The study could not be refreshed.').waitFor({ state: 'detached', timeout: 20_000 });
    await context.close();
  });
});

it('a probing trial shows its signals, its force against depth with the wall behind, and leads back to its study', async (context) => {
  const { page, faults } = seen;
  const study = await someStudy(page);
  if (!inject('fixture')) context.skip(!study, 'this server holds no study');
  if (!study) throw new Error('the server has no study with a trial that counts');
  await page.goto(`/trials/${study.trial}`);
  for (const panel of ['force', 'depth', 'speed', 'turn']) {
    const canvas = page.locator(`[data-panel="${panel}"] canvas`).first();
    await expect.poll(() => inked(canvas), { timeout: 15_000 }).toBeGreaterThan(2000);
  }
  await page.locator('[data-part="depth-curve"]').waitFor();
  const path = (await page.locator('[data-part="depth-curve"]').getAttribute('d')) ?? '';
  expect(path.split('L').length).toBeGreaterThan(200);
  const { scenario } = await asked<{ scenario: { walls: unknown[] } }>(page, `/trials/${study.trial}`);
  expect(await page.locator('[data-part="wall"]').count()).toBe(scenario.walls.length);
  // The moment pointed at in one picture is named in the other.
  const box = (await page.locator('[data-panel="force"] .u-over').boundingBox())!;
  await page.mouse.move(box.x + box.width / 2, box.y + 40);
  await page.locator('[data-part="depth-chart"] circle').waitFor();
  await page
    .getByRole('link', { name: /.+/ })
    .filter({ hasText: /rials|study/i })
    .first()
    .waitFor();
  await page.locator(`a[href="/studies/${study.id}"]`).click();
  await page.getByRole('table', { name: 'Participants and their trials' }).waitFor();
  expect(faults).toEqual([]);
});
