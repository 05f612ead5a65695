/** The DICOM series among the files that a person dropped, so that one can be chosen before anything is sent. */
import type { DataSet } from 'dicom-parser';
import type { Dropped } from '@/ui';
import { metre, type Metre } from '@/units';
import type { Series } from './series-table';

/** Pixels of a slice as bytes, 0 black to 255 white. */
export interface Picture {
  readonly width: number;
  readonly height: number;
  readonly grey: Uint8ClampedArray<ArrayBuffer>;
}

/** `slice_spacing_m`: the median distance between neighbouring slices. */
export interface DicomSeries extends Series {
  /** In the order of the slices along their normal. */
  readonly slices: readonly Dropped[];
}

interface Slice {
  readonly dropped: Dropped;
  readonly tags: DataSet;
}

// What comes before the pixels is mostly shorter; a longer file is read as a whole.
const kHead_bytes = 64 * 1024;
const kPixels = 'x7fe00010';
const kUncompressed = ['1.2.840.10008.1.2', '1.2.840.10008.1.2.1'];
/** Bone and what is round it. */
const kWindow = { low: -200, high: 1200 };

/** A file of DICOM begins with 128 bytes of anything and these letters (PS3.10, section 7.1). */
const isDicom = (head: Uint8Array) => String.fromCharCode(...head.subarray(128, 132)) === 'DICM';

async function tagsOf({ file }: Dropped): Promise<DataSet | null> {
  const { parseDicom } = await import('dicom-parser');
  const bytesOf = async (size: number) => new Uint8Array(await file.slice(0, size).arrayBuffer());
  const head = await bytesOf(kHead_bytes);
  if (!isDicom(head)) return null;
  try {
    return parseDicom(head, { untilTag: kPixels });
  } catch {
    return parseDicom(await bytesOf(file.size), { untilTag: kPixels });
  }
}

function numbers(tags: DataSet, tag: string): number[] | null {
  const values = tags.string(tag)?.split('\\').map(Number) ?? [];
  return values.length > 0 && values.every(Number.isFinite) ? values : null;
}

function inMetres(value_mm: number | undefined): Metre | null {
  return value_mm !== undefined && value_mm > 0 ? metre(value_mm / 1000) : null;
}

/** Along the slices' normal, in millimetres; null where a file states no position. */
function place_mm(tags: DataSet): number | null {
  const [x, y, z] = numbers(tags, 'x00200032') ?? [];
  const [a, b, c, d, e, f] = numbers(tags, 'x00200037') ?? [];
  if (x === undefined || y === undefined || z === undefined) return null;
  if (a === undefined || b === undefined || c === undefined) return null;
  if (d === undefined || e === undefined || f === undefined) return null;
  return x * (b * f - c * e) + y * (c * d - a * f) + z * (a * e - b * d);
}

function median(values: readonly number[]): number | undefined {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[sorted.length >> 1];
}

function seriesOf(uid: string, slices: readonly Slice[]): DicomSeries {
  const placed = slices
    .map((slice) => ({ slice, place: place_mm(slice.tags) }))
    .sort((a, b) => (a.place ?? 0) - (b.place ?? 0));
  const places = placed.flatMap(({ place }) => (place === null ? [] : [place]));
  const tags = slices[0]?.tags;
  const text = (tag: string) => tags?.string(tag)?.trim() ?? '';
  const spacing_mm = (tags && numbers(tags, 'x00280030')) ?? [];
  return {
    uid,
    number: tags?.intString('x00200011') ?? null,
    description: text('x0008103e'),
    modality: text('x00080060'),
    files: slices.length,
    row_spacing_m: inMetres(spacing_mm[0]),
    column_spacing_m: inMetres(spacing_mm[1]),
    slice_spacing_m: inMetres(median(places.slice(1).map((place, i) => place - (places[i] ?? place)))),
    thickness_m: inMetres((tags && numbers(tags, 'x00180050'))?.[0]),
    slices: placed.map(({ slice }) => slice.dropped),
  };
}

/** Every series, the one with most files first. Files that are no DICOM belong to none. `onFile`: how many were read. */
export async function dicomSeries(
  dropped: readonly Dropped[],
  onFile: (done: number) => void = () => undefined,
): Promise<DicomSeries[]> {
  const groups = new Map<string, Slice[]>();
  for (const [i, one] of dropped.entries()) {
    const tags = await tagsOf(one).catch(() => null); // a damaged file belongs to no series
    const uid = tags?.string('x0020000e')?.trim();
    if (tags && uid !== undefined) groups.set(uid, [...(groups.get(uid) ?? []), { dropped: one, tags }]);
    onFile(i + 1);
  }
  return [...groups].map(([uid, slices]) => seriesOf(uid, slices)).sort((a, b) => b.slices.length - a.slices.length);
}

/** The middle slice of a series in a window for bone; null where its pixels are compressed or not of 16 bits. */
export async function middleSlice(series: DicomSeries): Promise<Picture | null> {
  const { parseDicom } = await import('dicom-parser');
  const file = series.slices[series.slices.length >> 1]?.file;
  if (!file) return null;
  const bytes = new Uint8Array(await file.arrayBuffer());
  const tags = parseDicom(bytes);
  const height = tags.uint16('x00280010') ?? 0,
    width = tags.uint16('x00280011') ?? 0;
  const pixels = tags.elements[kPixels];
  const isPlain = kUncompressed.includes(tags.string('x00020010') ?? '') && tags.uint16('x00280100') === 16;
  if (!pixels || !isPlain || width * height === 0 || pixels.length < 2 * width * height) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset + pixels.dataOffset, 2 * width * height);
  const isSigned = tags.uint16('x00280103') === 1;
  const slope = tags.floatString('x00281053') ?? 1,
    intercept = tags.floatString('x00281052') ?? 0;
  const grey = new Uint8ClampedArray(width * height);
  for (let i = 0; i < grey.length; ++i) {
    const stored = isSigned ? view.getInt16(2 * i, true) : view.getUint16(2 * i, true);
    grey[i] = (255 * (stored * slope + intercept - kWindow.low)) / (kWindow.high - kWindow.low);
  }
  return { width, height, grey };
}
