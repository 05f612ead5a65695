/** Files that were dropped, as the one zip that the server takes. */
import type { AsyncZippable } from 'fflate';
import { say } from '@/language';
import type { Dropped } from '@/ui';
import { zipped } from './recording/zipped';

export interface Packed {
  readonly name: string;
  readonly zip: Uint8Array<ArrayBuffer>;
}

const kMost_bytes = 256 * 1024 * 1024;

const withoutSlash = (path: string) => path.replace(/^(\.?\/)+/, '');

/** The folder that holds set.json, with its slash; null where there is none. The highest one counts. */
export function rootOf(paths: readonly string[]): string | null {
  const found = paths
    .map(withoutSlash)
    .filter((path) => path === 'set.json' || path.endsWith('/set.json'))
    .sort((a, b) => a.split('/').length - b.split('/').length)[0];
  return found === undefined ? null : found.slice(0, -'set.json'.length);
}

/** The name that set.json itself gives, for files that were dropped without their folder. */
async function statedName(set: File | undefined): Promise<string | undefined> {
  try {
    const json: unknown = JSON.parse((await set?.text()) ?? '');
    if (
      typeof json === 'object' &&
      json !== null &&
      'name' in json &&
      typeof json.name === 'string' &&
      json.name.trim() !== ''
    )
      return json.name.trim();
  } catch {
    /* what is wrong with it the server says, by its line */
  }
  return undefined;
}

/** Errors: a sentence for the person who dropped them. */
export async function pack(dropped: readonly Dropped[]): Promise<Packed> {
  const [only] = dropped;
  if (!only) throw new Error(say('No files were selected.'));
  if (dropped.length === 1 && /\.zip$/i.test(only.file.name)) {
    if (only.file.size > kMost_bytes)
      throw new Error(say('{name}: larger than the limit of 256 MiB.', { name: only.file.name }));
    return { name: only.file.name.replace(/\.zip$/i, ''), zip: new Uint8Array(await only.file.arrayBuffer()) };
  }
  const root = rootOf(dropped.map(({ path }) => path));
  if (root === null)
    throw new Error(
      say(
        'set.json is missing. Choose a folder with set.json and one CSV file per trial, or a zip file of such a folder.',
      ),
    );
  const inside = dropped
    .map(({ path, file }) => ({ path: withoutSlash(path), file }))
    .filter(({ path }) => path.startsWith(root) && !path.split('/').some((part) => part.startsWith('.')));
  const size = inside.reduce((sum, { file }) => sum + file.size, 0);
  if (size > 4 * kMost_bytes) throw new Error(say('The folder is larger than the limit of 1 GiB.'));
  const stated = await statedName(inside.find(({ path }) => path === `${root}set.json`)?.file);
  const files: AsyncZippable = {};
  for (const { path, file } of inside) files[path.slice(root.length)] = new Uint8Array(await file.arrayBuffer());
  const data = await zipped(files);
  if (data.length > kMost_bytes) throw new Error(say('The compressed folder is larger than the limit of 256 MiB.'));
  return { name: root.split('/').filter(Boolean).at(-1) ?? stated ?? say('Measurements'), zip: data };
}

/** One fault a line, "FILE:LINE: what is wrong", as the server writes them. */
export interface Problem {
  readonly file: string;
  readonly line: number | null;
  readonly what: string;
}

export function problemsOf(message: string): Problem[] {
  return message
    .split('\n')
    .map((text) => text.trim())
    .filter(Boolean)
    .map((text) => {
      const match = /^([^\s:]+\.[A-Za-z0-9]+)(?:[:,]\s*(?:line\s*)?(\d+))?:\s*(.+)$/.exec(text);
      return match?.[1] !== undefined && match[3] !== undefined
        ? { file: match[1], line: match[2] === undefined ? null : Number(match[2]), what: match[3] }
        : { file: '', line: null, what: text };
    });
}
