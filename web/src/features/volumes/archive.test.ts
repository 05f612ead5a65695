// @vitest-environment node
import { zipSync } from 'fflate';
import { expect, it } from 'vitest';
import { opened } from './archive';

const text = (words: string) => new TextEncoder().encode(words);
const zipped = (name: string, inside: Record<string, Uint8Array>) => ({
  path: name,
  file: new File([zipSync(inside) as Uint8Array<ArrayBuffer>], name),
});

it('opens a zip to its files, without its folders', async () => {
  const files = await opened([zipped('CD.ZIP', { 'a/': text(''), 'a/1': text('one'), '2': text('two') })]);
  expect(files.map(({ path }) => path).sort()).toEqual(['2', 'a/1']);
  expect(await files.find(({ path }) => path === 'a/1')?.file.text()).toBe('one');
});

it('leaves all others as they are: a folder, a volume, a damaged zip', async () => {
  const folder = ['1', '2'].map((path) => ({ path, file: new File(['x'], path) }));
  expect(await opened(folder)).toBe(folder);
  const volume = [{ path: 'L3.nrrd', file: new File(['x'], 'L3.nrrd') }];
  expect(await opened(volume)).toBe(volume);
  const damaged = [{ path: 'CD.zip', file: new File(['no zip'], 'CD.zip') }];
  expect(await opened(damaged)).toBe(damaged);
});

it('leaves a zip that claims to unpack to more than a page can hold', async () => {
  const bomb = zipped('CD.zip', { '1': text('small') });
  const bytes = new Uint8Array(await bomb.file.arrayBuffer());
  // The size in the central directory (PKWARE APPNOTE 4.3.12: 24 bytes from the signature PK\1\2).
  const at = bytes.findIndex(
    (_, i) => bytes[i] === 0x50 && bytes[i + 1] === 0x4b && bytes[i + 2] === 1 && bytes[i + 3] === 2,
  );
  new DataView(bytes.buffer).setUint32(at + 24, 0xfffffff0, true);
  const lying = [{ path: 'CD.zip', file: new File([bytes], 'CD.zip') }];
  expect(await opened(lying)).toBe(lying);
});
