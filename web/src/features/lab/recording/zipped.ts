import { zip, type AsyncZippable } from 'fflate';

/** A zip of these files by name. They are used up. */
export function zipped(files: AsyncZippable): Promise<Uint8Array<ArrayBuffer>> {
  return new Promise((resolve, reject) => {
    zip(files, { level: 3, consume: true }, (failure, data) => {
      if (failure) reject(failure);
      else resolve(data as Uint8Array<ArrayBuffer>);
    });
  });
}
