/** The files in a zip that a person dropped, so that its series can be told apart as those of a folder are. */
import { unzip, type UnzipFileInfo } from 'fflate';
import type { Dropped } from '@/ui';

// A page holds both the zip and its files in memory. A larger one goes to the server as it is.
const kMost_bytes = 1024 * 1024 * 1024;

const isFolder = ({ name }: UnzipFileInfo) => name.endsWith('/');

function files(bytes: Uint8Array, isWanted: (file: UnzipFileInfo) => boolean): Promise<[string, Uint8Array][]> {
  return new Promise((resolve, reject) => {
    unzip(bytes, { filter: isWanted }, (failure, inside) => {
      if (failure) reject(failure);
      else resolve(Object.entries(inside));
    });
  });
}

/** What stands in the zip, or what was dropped where it is no zip alone, one that is damaged, or too large. */
export async function opened(dropped: readonly Dropped[]): Promise<readonly Dropped[]> {
  const [only] = dropped;
  if (!only || dropped.length > 1 || !/\.zip$/i.test(only.file.name) || only.file.size > kMost_bytes) return dropped;
  try {
    const bytes = new Uint8Array(await only.file.arrayBuffer());
    let size = 0;
    await files(bytes, ({ originalSize }) => {
      size += originalSize;
      return false;
    });
    if (size > kMost_bytes) return dropped;
    const inside = await files(bytes, (file) => !isFolder(file));
    return inside.map(([path, data]) => ({ path, file: new File([data as Uint8Array<ArrayBuffer>], path) }));
  } catch {
    return dropped; // the server says what is wrong with it
  }
}
