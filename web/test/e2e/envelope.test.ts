/** The envelope of a vertebra on the page that makes a case: its outline in the slices, and marks that correct it. */
import type { Browser, Page, Request } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, inject, it } from 'vitest';
import { asked, launch, signIn, visit } from './browser';
import { checker } from './looks';

interface Mark {
  at_m: number[];
  radius_m: number;
  bone: boolean;
}
interface Wish {
  preparation: string;
  envelope_marks?: Mark[];
}

/** Entry and target of the fixture's own tract, in millimetres (test/fixture/simulate.ts). */
const kPlan = 'entry=21,34,108&target=9.2,-5.9,103';

let browser: Browser, page: Page, volume: string;
beforeAll(async () => {
  browser = await launch();
  ({ page } = await visit(browser, { height: 1000 }));
  await signIn(page);
  const { volumes } = await asked<{ volumes: { id: string; state: string }[] }>(page, '/volumes');
  volume = volumes.find(({ state }) => state === 'released')?.id ?? '';
});
afterAll(() => browser.close());

const isPlan = (request: Request) => request.url().endsWith('/tract');
const wishOf = (request: Request) => request.postDataJSON() as Wish;
const outline = (plane = 'axial') => page.locator(`[data-plane="${plane}"] [data-part="outline"] path`).last();
const slice = (plane = 'axial') => page.locator(`[data-plane="${plane}"] svg`);
const shape = () => outline().getAttribute('d');
const marksInAddress = () => new URL(page.url()).searchParams.get('marks')?.split(';').length ?? 0;

async function open(more = ''): Promise<void> {
  await page.goto(`/cases/new/${volume}?${kPlan}${more}`);
  await outline().waitFor();
}

/** What the page asks of the server once `act` is done, when its outline is another than before. */
async function changedBy(act: () => Promise<void>): Promise<Wish> {
  const before = await shape();
  const [request] = await Promise.all([page.waitForRequest(isPlan), act()]);
  await expect.poll(shape, { timeout: 20_000 }).not.toBe(before);
  return wishOf(request);
}

/** A place on the screen at the side of the vertebra's body, which is in the front of the axial slice. */
async function sideOfOutline(): Promise<{ x: number; y: number }> {
  const box = await outline().boundingBox();
  if (!box) throw new Error('no outline');
  return { x: box.x + 2, y: box.y + box.height * 0.35 };
}

describe.runIf(inject('fixture'))('the envelope', () => {
  it('is drawn in each slice, with words for the outline and the peaks of the CT', async () => {
    await open();
    for (const plane of ['axial', 'coronal', 'sagittal'])
      expect(await outline(plane).getAttribute('d')).toMatch(/^M.*L/);
    await page.getByText('Envelope: outer face of the vertebra').waitFor();
    expect(await page.locator('[data-part="peaks"]').innerText()).toMatch(
      /air −1003\sHU, fat −95\sHU, soft tissue 42\sHU, cancellous bone 85\sHU, cortical bone 620\sHU/,
    );
  });

  it('changes by a mark that a mouse paints, which undo takes back', async () => {
    await open();
    const first = await shape();
    await page.getByRole('radio', { name: 'No bone here', exact: true }).check();
    const { x, y } = await sideOfOutline();
    const wish = await changedBy(() => page.mouse.click(x, y));
    expect(wish.envelope_marks).toMatchObject([{ bone: false, radius_m: 0.003 }]);
    expect(await slice().locator('g[data-sign="−"]').count()).toBeGreaterThan(0);
    await expect.poll(marksInAddress).toBe(1);
    await page.getByRole('button', { name: 'Undo' }).click();
    await expect.poll(shape).toBe(first);
    await expect.poll(marksInAddress).toBe(0);
  });

  it('changes by a stroke, one step to undo, and by the button that removes all marks', async () => {
    await open();
    const first = await shape();
    await page.getByRole('radio', { name: 'No bone here', exact: true }).check();
    await page.getByRole('slider', { name: 'Brush radius' }).fill('2');
    const { x, y } = await sideOfOutline();
    // The page asks while the mouse still moves, too, where the stroke is slow: the last question has the whole of it.
    const questions: Request[] = [];
    const note = (request: Request) => isPlan(request) && questions.push(request);
    page.on('request', note);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 10, y + 30);
    await page.mouse.move(x + 20, y + 60);
    await page.mouse.up();
    await expect.poll(shape, { timeout: 20_000 }).not.toBe(first);
    const painted = Number.parseInt(await page.getByText(/^\d+ marks on the envelope$/).innerText());
    const lastMarks = () => questions.map(wishOf).at(-1)?.envelope_marks ?? [];
    await expect.poll(() => lastMarks().length).toBe(painted);
    page.off('request', note);
    const marks = lastMarks();
    expect(marks.length).toBeGreaterThan(3);
    // One mark for each half radius of the way, 1 mm.
    const [a, b] = marks.slice(1).map(({ at_m }) => at_m);
    expect(Math.hypot(...(a ?? []).map((value, i) => value - (b?.[i] ?? 0)))).toBeCloseTo(0.001, 5);
    await page.getByText(`${marks.length} marks on the envelope`).waitFor();
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.getByText('0 marks on the envelope').waitFor();
    await expect.poll(shape).toBe(first);
    await page.getByRole('button', { name: 'Redo' }).click();
    await page.getByText(`${marks.length} marks on the envelope`).waitFor();
    await page.getByRole('radio', { name: 'Remove marks here', exact: true }).check();
    expect(await slice().getAttribute('aria-label')).toContain('removes marks');
    await page.getByRole('slider', { name: 'Brush radius' }).fill('1.5');
    await page.mouse.click(x, y); // touches what lies within 1.5 mm and a mark's 2 mm, one a millimetre: the first four
    await page.getByText(`${marks.length - 4} marks on the envelope`).waitFor();
    await page.getByRole('button', { name: 'Remove all marks' }).click();
    await page.getByText('0 marks on the envelope').waitFor();
  });

  it('changes by a mark that keys paint', async () => {
    await open();
    await page.getByRole('radio', { name: 'No bone here', exact: true }).check();
    await slice().focus();
    expect(await slice().getAttribute('aria-label')).toContain('Enter paints');
    // The brush begins at the entry, on the outer face. Two millimetres to the front, at 0.5 mm a key.
    for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowUp');
    const wish = await changedBy(() => page.keyboard.press('Enter'));
    expect(wish.envelope_marks).toHaveLength(1);
    const [x = 0, y = 0, z = 0] = wish.envelope_marks?.[0]?.at_m ?? [];
    expect([x, y, z].map((value) => Math.round(value * 1e4))).toEqual([210, 320, 1080]);
  });

  it('keeps its marks in the address and in the case, but not for published bone', async () => {
    const [request] = await Promise.all([page.waitForRequest(isPlan), open('&marks=21,32,108,3,-;9,-20,103,2.5,+')]);
    const marks = [
      { at_m: [0.021, 0.032, 0.108], radius_m: 0.003, bone: false },
      { at_m: [0.009, -0.02, 0.103], radius_m: 0.0025, bone: true },
    ];
    expect(wishOf(request).envelope_marks).toEqual(marks);
    const [published] = await Promise.all([
      page.waitForRequest(isPlan),
      page.getByLabel('Bone', { exact: true }).selectOption('published'),
    ]);
    expect(wishOf(published)).not.toHaveProperty('envelope_marks');
    await outline().waitFor({ state: 'detached' });
    expect(await page.getByRole('radio', { name: 'Bone here', exact: true }).count()).toBe(0);
    await page.getByLabel('Bone', { exact: true }).selectOption('filled');
    await outline().waitFor();
    await page.getByLabel('Title (not shown to trainees)').fill('L3 left, corrected');
    const [made] = await Promise.all([
      page.waitForRequest((one) => one.url().endsWith('/api/v1/cases') && one.method() === 'POST'),
      page.getByRole('button', { name: 'Create case' }).click(),
    ]);
    expect(wishOf(made).envelope_marks).toEqual(marks);
  });

  it('comes with advice where the server refuses it, and says when there can be no more marks', async () => {
    await page.route('**/tract', async (route) => {
      const answer = await route.fetch();
      const found = (await answer.json()) as object;
      await route.fulfill({ json: { ...found, problems: ['the bone goes on into a rib'] } });
    });
    const marks = Array.from({ length: 200 }, (_, i) => `${i / 10},30,108,1,-`).join(';');
    await open(`&marks=${marks}`);
    await page.locator('[data-part="advice"]').waitFor();
    await page.getByText('200 marks are the most that there can be').waitFor();
    await page.unroute('**/tract');
  });

  it.each([1440, 390])(
    'is legible at %d px, in both colour schemes',
    async (width) => {
      const other = await visit(browser, { width, height: 1000 });
      await signIn(other.page);
      await other.page.goto(`/cases/new/${volume}?${kPlan}&marks=21,32,108,3,-;9,-20,103,2.5,+`);
      await other.page.locator('[data-plane="axial"] [data-part="outline"]').waitFor();
      await other.page.getByRole('radio', { name: 'No bone here', exact: true }).check();
      await other.page.locator('[data-plane="axial"] svg').focus();
      await other.page.keyboard.press('ArrowRight');
      await other.page.waitForLoadState('networkidle');
      await other.page.locator('[data-part="scene"][data-ready]').waitFor();
      await checker(other.page, { width, dark: false })('case-new-envelope');
      expect(other.faults).toEqual([]);
      await other.context.close();
    },
    180_000,
  ); // axe-core reads hundreds of lines of walls, in two schemes
});
