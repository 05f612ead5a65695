/** A folder and a zip with two series in them, from the choice to the volume on a real server. The CT is simulated. */
import { execFileSync } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { kShots, launch } from '../browser';
import { programs, serveReal, type Served } from '../real-server';

const bin = programs('tractus-server');
const kWriters = fileURLToPath(new URL('../../../../tests/dicomweb', import.meta.url));
// 6 slices of 3 mm and 12 of 1 mm, in one folder as a CD has them, beside its index.
const kWrite = `
import pathlib, shutil, sys
sys.path.insert(0, sys.argv[1])
import series
folder = pathlib.Path(sys.argv[2])
for uid, slices, mm, words, number in (("2.25.11", 6, 3.0, "soft tissue", 2), ("2.25.12", 12, 1.0, "bone", 3)):
    for k, data in enumerate(series.series(uid, slices, side=32, spacing_mm=0.5, thickness_mm=mm, description=words,
                                           number_of_series=number)):
        (folder / f"{number}{k:03}").write_bytes(data)
(folder / "DICOMDIR").write_bytes(b"an index")
shutil.make_archive(sys.argv[2], "zip", folder.parent, folder.name)
`;

describe.skipIf(bin === undefined)('a folder or a zip with two series', () => {
  let browser: Browser, served: Served, page: Page, folder: string;
  beforeAll(async () => {
    served = await serveReal(bin ?? '');
    folder = join(served.folder, 'Mustermann^Erika');
    mkdirSync(folder);
    execFileSync('/usr/bin/python3', ['-B', '-c', kWrite, kWriters, folder]);
    browser = await launch();
    const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, baseURL: served.url });
    page = await context.newPage();
    page.setDefaultTimeout(30_000);
    await page.goto('/volumes');
    await page.getByLabel('Name').fill(served.account.name);
    await page.getByLabel('Password').fill(served.account.password);
    await page.getByRole('button', { name: 'Sign in' }).click();
    await page.getByRole('heading', { name: 'Upload a volume' }).waitFor();
  }, 60_000);
  afterAll(async () => {
    await browser.close();
    await served.stop();
  });

  it('is shown with what each series is, and waits for a choice', async () => {
    await page.getByLabel('A folder of DICOM slices').setInputFiles(folder);
    await page.getByText('2 series were found. Choose one.').waitFor();
    const rows = page.getByRole('table', { name: 'Series of the study' }).locator('tbody tr');
    expect(await rows.count()).toBe(2);
    const thin = (await rows.nth(0).innerText()).replace(/\s+/g, ' '); // the one with most slices comes first
    expect(thin).toMatch(/3 bone CT 12 0\.50 mm 1\.00 mm 1\.00 mm/);
    expect((await rows.nth(1).innerText()).replace(/\s+/g, ' ')).toMatch(
      /2 soft tissue CT 6 0\.50 mm 3\.00 mm 3\.00 mm/,
    );
    expect(await rows.locator('canvas').count()).toBe(2);
    // The picture is the slice's: a ramp that grows to the right and down.
    const grey = await rows
      .nth(0)
      .locator('canvas')
      .evaluate((canvas: HTMLCanvasElement) => {
        const { data, width, height } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
        return [data[0] ?? 0, data[4 * (width - 1)] ?? 0, data[4 * width * (height - 1)] ?? 0];
      });
    expect(grey[1]).toBeGreaterThan((grey[0] ?? 0) + 40); // 10 a pixel of 1400 in the window: 56 of 255
    expect(grey[2]).toBeGreaterThan(grey[0] ?? 0);
    expect(await page.getByLabel('Name, without a patient’s name').first().inputValue()).toBe('');
    await page.getByLabel('Name, without a patient’s name').first().fill('simulated spine');
    expect(await page.getByRole('button', { name: 'Upload', exact: true }).isDisabled()).toBe(true);
    await page.screenshot({ path: `${kShots}volumes-series.png`, fullPage: true });
  });

  it('becomes a volume of the chosen series alone', async () => {
    await upload('Choose series 3', 12);
    expect(await volume()).toEqual({ dims: [32, 32, 12], spacing_mm: [0.5, 0.5, 1] });
  });

  it('is opened where it is a zip', async () => {
    await page.goto('/volumes');
    await page.getByLabel('A zip of DICOM slices, or a NIfTI, NRRD or .tvol file').setInputFiles(`${folder}.zip`);
    await page.getByText('2 series were found. Choose one.').waitFor();
    expect(await page.getByRole('table', { name: 'Series of the study' }).locator('canvas').count()).toBe(2);
    expect(await page.getByLabel('Name, without a patient’s name').first().inputValue()).toBe('');
    await page.getByLabel('Name, without a patient’s name').first().fill('simulated spine, thick slices');
    await upload('Choose series 2', 6);
    expect(await volume()).toEqual({ dims: [32, 32, 6], spacing_mm: [0.5, 0.5, 3] });
  });

  async function upload(choice: string, count: number): Promise<void> {
    await page.getByRole('button', { name: choice }).click();
    await page.getByText(`${count} files`).first().waitFor();
    await page.getByRole('button', { name: 'Upload', exact: true }).click();
    await page.waitForURL(/\/volumes\/[0-9a-f]{32}$/);
  }

  /** What the server says of the volume whose page is shown. */
  async function volume(): Promise<{ dims: number[]; spacing_mm: number[] }> {
    const { dims, spacing_m } = await page.evaluate(async (id) => {
      const answer = await fetch(`/api/v1/volumes/${id}`);
      return (await answer.json()) as { dims: number[]; spacing_m: number[] };
    }, page.url().split('/').at(-1));
    return { dims, spacing_mm: spacing_m.map((value) => Number((1000 * value).toFixed(3))) };
  }
});
