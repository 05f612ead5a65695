// @vitest-environment node
import { expect, it, vi } from 'vitest';
import { dicomSeries, middleSlice } from './dicom-series';

/** A data element in Explicit VR Little Endian (DICOM PS3.5, section 7.1.2). */
function element(group: number, tag: number, vr: string, value: string | Uint8Array): Uint8Array {
  const bytes = typeof value === 'string' ? new TextEncoder().encode(value.length % 2 ? `${value} ` : value) : value;
  const isLong = vr === 'OW' || vr === 'OB';
  const head = new DataView(new ArrayBuffer(isLong ? 12 : 8));
  head.setUint16(0, group, true);
  head.setUint16(2, tag, true);
  head.setUint8(4, vr.charCodeAt(0));
  head.setUint8(5, vr.charCodeAt(1));
  if (isLong) head.setUint32(8, bytes.length, true);
  else head.setUint16(6, bytes.length, true);
  return new Uint8Array([...new Uint8Array(head.buffer), ...bytes]);
}
const short = (...values: number[]) => new Uint8Array(new Int16Array(values).buffer);

/** A slice of 2 × 3 pixels at z; `long`: bytes of a private element before the pixels. */
function slice(
  uid: string,
  z_mm: number,
  { number = '1', pixels = short(0, 0, 0, 0, 0, 0), long = 0, syntax = '1' } = {},
) {
  const meta = element(2, 0x10, 'UI', `1.2.840.10008.1.2.${syntax}\0`.slice(0, 20));
  const parts = [
    new Uint8Array(128),
    new TextEncoder().encode('DICM'),
    element(2, 0, 'UL', new Uint8Array([meta.length, 0, 0, 0])),
    meta,
    element(0x08, 0x60, 'CS', 'CT'),
    element(0x08, 0x103e, 'LO', 'bone'),
    element(0x18, 0x50, 'DS', '1.25'),
    element(0x20, 0x0e, 'UI', uid),
    element(0x20, 0x11, 'IS', number),
    element(0x20, 0x32, 'DS', `-10\\20\\${z_mm}`),
    element(0x20, 0x37, 'DS', '1\\0\\0\\0\\1\\0'),
    element(0x28, 0x10, 'US', short(2)),
    element(0x28, 0x11, 'US', short(3)),
    element(0x28, 0x30, 'DS', '0.5\\0.4'),
    element(0x28, 0x100, 'US', short(16)),
    element(0x28, 0x103, 'US', short(1)),
    element(0x28, 0x1052, 'DS', '-100'),
    element(0x28, 0x1053, 'DS', '2'),
    element(0x29, 0x1010, 'OB', new Uint8Array(long)),
    element(0x7fe0, 0x10, 'OW', pixels),
  ];
  const name = `${uid}-${z_mm}`;
  return { path: `folder/${name}`, file: new File(parts as Uint8Array<ArrayBuffer>[], name) };
}

it('tells the series of a folder apart, the longest first, each in the order of its slices', async () => {
  const folder = [
    slice('1.2.3.4', 0, { number: '7' }),
    slice('1.2.3.45', 2),
    slice('1.2.3.45', 0),
    slice('1.2.3.45', 3),
    slice('1.2.3.45', 1),
    { path: 'folder/DICOMDIR', file: new File(['not a slice'], 'DICOMDIR') },
  ];
  const read: number[] = [];
  const found = await dicomSeries(folder, (done) => read.push(done));
  expect(found.map(({ uid, number, files }) => [uid, number, files])).toEqual([
    ['1.2.3.45', 1, 4],
    ['1.2.3.4', 7, 1],
  ]);
  expect(found[0]?.slices.map(({ file }) => file.name)).toEqual([
    '1.2.3.45-0',
    '1.2.3.45-1',
    '1.2.3.45-2',
    '1.2.3.45-3',
  ]);
  expect(found[0]).toMatchObject({
    description: 'bone',
    modality: 'CT',
    row_spacing_m: 0.0005,
    column_spacing_m: 0.0004,
    thickness_m: 0.00125,
    slice_spacing_m: 0.001,
  });
  expect(found[1]?.slice_spacing_m).toBeNull();
  expect(read).toEqual([1, 2, 3, 4, 5, 6]);
});

it('reads a file whose description is longer than the part that is read first', async () => {
  const [found] = await dicomSeries([slice('1.2.3.4', 0, { long: 100_000 })]);
  expect(found?.uid).toBe('1.2.3.4');
});

async function pictureOf(files: Parameters<typeof dicomSeries>[0]) {
  const [series] = await dicomSeries(files);
  if (!series) throw new Error('no series');
  return middleSlice(series);
}

it('shows the middle slice in a window for bone', async () => {
  // CT value = 2 × stored − 100; the window is −200 to 1200: 500 is the grey in its middle.
  const pixels = short(-50, 300, 650, -500, 1000, -50);
  const picture = await pictureOf([slice('1.2.3.4', 0), slice('1.2.3.4', 1, { pixels }), slice('1.2.3.4', 2)]);
  expect([picture?.width, picture?.height]).toEqual([3, 2]);
  expect([...(picture?.grey ?? [])]).toEqual([0, 128, 255, 0, 255, 0]);
});

it('has no picture of compressed pixels', async () => {
  expect(await pictureOf([slice('1.2.3.4', 0, { syntax: '5' })])).toBeNull();
});

it('finds nothing in files that are no DICOM', async () => {
  expect(await dicomSeries([{ path: 'L3.nrrd', file: new File(['NRRD0005'], 'L3.nrrd') }])).toEqual([]);
});

it('reads only the beginning of a file that is no DICOM, which may be a volume of a gigabyte', async () => {
  const file = new File([new Uint8Array(1_000_000)], 'L3.nii');
  const whole = vi.spyOn(file, 'arrayBuffer');
  const read = vi.spyOn(file, 'slice');
  await dicomSeries([{ path: 'L3.nii', file }]);
  expect(whole).not.toHaveBeenCalled();
  expect(read.mock.calls).toEqual([[0, 65_536]]);
});

it('leaves out a file that ends in the middle', async () => {
  const { path, file } = slice('1.2.3.4', 0);
  expect(await dicomSeries([{ path, file: new File([file.slice(0, 200)], 'cut') }])).toEqual([]);
});
