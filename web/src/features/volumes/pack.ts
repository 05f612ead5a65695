/** What was dropped, as the one file that the server takes. */
import { zip, type AsyncZippable } from 'fflate';
import type { Dropped } from '@/ui';

const kMost_bytes = 1024 * 1024 * 1024;
const kVolume = /\.(zip|nii|nii\.gz|nrrd|tvol)$/i;

const isHidden = (path: string) => path.split('/').some((part) => /^\.[^./]/.test(part) || part === '__MACOSX');

/** A name to begin with: that of a volume file. Folders and archives of DICOM files are often named after the patient. */
export function nameFrom(dropped: readonly Dropped[]): string {
  const [only] = dropped;
  if (!only || dropped.length > 1 || !kVolume.test(only.file.name) || /\.zip$/i.test(only.file.name)) return '';
  return only.file.name.replace(kVolume, '');
}

/** Errors: a sentence for the person who dropped them. */
export async function pack(dropped: readonly Dropped[]): Promise<Blob> {
  const files = dropped.filter(({ path }) => !isHidden(path));
  const [only] = files;
  if (!only) throw new Error('No files were selected.');
  const size = files.reduce((sum, { file }) => sum + file.size, 0);
  if (size > kMost_bytes) throw new Error('A volume of at most 1 GiB is expected.');
  if (files.length === 1 && kVolume.test(only.file.name)) return only.file;
  const inside: AsyncZippable = {};
  // Names of DICOM files may name a patient: the server needs none of them.
  for (const [i, { file }] of files.entries()) inside[`${i + 1}.dcm`] = new Uint8Array(await file.arrayBuffer());
  return new Promise((resolve, reject) => {
    zip(inside, { level: 1, consume: true }, (failure, data) => {
      if (failure) reject(failure);
      else resolve(new Blob([data as Uint8Array<ArrayBuffer>]));
    });
  });
}
