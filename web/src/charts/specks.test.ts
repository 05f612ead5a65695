import { describe, expect, it } from 'vitest';
import { withoutSpecks } from './scene/specks';

const dims = [20, 10, 10] as const;
const at = (i: number, j: number, k: number) => i + 20 * (j + 10 * k);

/** A block of 8 × 8 × 8 voxels, and what else there is. */
function bone(more: readonly number[]): Uint8Array {
  const opacity = new Uint8Array(2000);
  for (let n = 0; n < 512; ++n) opacity[at(1 + (n % 8), 1 + (Math.floor(n / 8) % 8), 1 + Math.floor(n / 64))] = 200;
  for (const voxel of more) opacity[voxel] = 200;
  return opacity;
}

describe('a picture without specks', () => {
  it('has lost a part of five voxels, and kept one of six beside a block of 512', () => {
    const five = [0, 1, 2, 3, 4].map((n) => at(15, 2 + n, 2));
    const six = [0, 1, 2, 3, 4, 5].map((n) => at(15, 2 + n, 7));
    const kept = withoutSpecks(bone([...five, ...six]), dims, 25.5);
    expect(five.every((voxel) => kept[voxel] === 0)).toBe(true);
    expect(six.every((voxel) => kept[voxel] === 200)).toBe(true);
    expect(kept[at(4, 4, 4)]).toBe(200);
  });
  it('keeps what touches the bone by a face, and what is fainter than its surface', () => {
    const opacity = bone([at(9, 4, 4)]);
    opacity[at(15, 5, 5)] = 20;
    const kept = withoutSpecks(opacity, dims, 25.5);
    expect(kept[at(9, 4, 4)]).toBe(200);
    expect(kept[at(15, 5, 5)]).toBe(20);
  });
  it('does not run around the end of a row', () => {
    const kept = withoutSpecks(bone([at(19, 2, 2), at(0, 3, 2)]), dims, 25.5);
    expect(kept[at(19, 2, 2)]).toBe(0);
  });
});
