/** What a picture shows, counted. */
import type { Browser, Locator } from 'playwright-core';

export interface Picture {
  readonly colours: number;
  readonly png: Buffer;
}

/** Distinct colours of an element as composed on the screen, coarsened to 4 bits a channel. */
export async function pictureOf(browser: Browser, element: Locator): Promise<Picture> {
  const png = await element.screenshot();
  const context = await browser.newContext(); // a page without the policy, that may decode a picture from memory
  const page = await context.newPage();
  const colours = await page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.width;
    canvas.height = image.height;
    const pen = canvas.getContext('2d');
    if (!pen) return 0;
    pen.drawImage(image, 0, 0);
    const { data } = pen.getImageData(0, 0, canvas.width, canvas.height);
    const seen = new Set<number>();
    for (let i = 0; i < data.length; i += 4)
      seen.add(((data[i]! >> 4) << 8) | ((data[i + 1]! >> 4) << 4) | (data[i + 2]! >> 4));
    return seen.size;
  }, png.toString('base64'));
  await context.close();
  return { colours, png };
}

/** Pixels of a 2-D canvas that are drawn at all. */
export function inked(canvas: Locator): Promise<number> {
  return canvas.evaluate((element) => {
    const surface = element as HTMLCanvasElement;
    const data = surface.getContext('2d')?.getImageData(0, 0, surface.width, surface.height).data ?? [];
    let count = 0;
    for (let i = 3; i < data.length; i += 4) if (data[i]! > 0) count += 1;
    return count;
  });
}
