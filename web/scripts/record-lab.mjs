/**
 * Records test/fixture/lab-recorded.json anew: what the programs answer on a SIMULATED set with hidden dry friction.
 *   node scripts/record-lab.mjs        with the programs of ../build/release/bin (or TRACTUS_BIN)
 */
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

const bin = process.env.TRACTUS_BIN ?? fileURLToPath(new URL('../../build/release/bin', import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'record-lab-'));
const kMost = { maxBuffer: 1 << 28, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] };

/** As many digits as a page shows and a few more: the file stays small. */
const short = (_, value) =>
  typeof value === 'number' && !Number.isInteger(value) ? Number(value.toPrecision(6)) : value;
/** Exit 1 is an answer too: "something is missing". */
function answer(...words) {
  try {
    return JSON.parse(execFileSync(join(bin, 'tractus'), [...words, '--json'], kMost));
  } catch (failure) {
    if (failure.status === 1 && failure.stdout) return JSON.parse(failure.stdout);
    throw failure;
  }
}

const set = join(folder, 'set');
execFileSync(
  join(bin, 'blind-probing'),
  ['--seed', '7', '--out', set, '--effect', 'coulomb_friction', '--trials', '8', '--duration', '6'],
  kMost,
);
const of = ['--model', join(set, 'model.json'), '--measurements', join(set, 'measurements')];
const recorded = {
  comparison: answer('compare', ...of),
  diagnosis: answer('diagnose', ...of),
  effects: answer('effects').effects.filter(({ rig }) => rig === 'probing'),
};
writeFileSync(new URL('../test/fixture/lab-recorded.json', import.meta.url), JSON.stringify(recorded, short));
rmSync(folder, { recursive: true });
