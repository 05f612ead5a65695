import { expect, it } from 'vitest';
import { discRadius_m, letterAt, stroke } from './slice-places';

// As server/api/volumes/volume_pictures.hpp has the planes: LPS along a row and down a column.
it.each([
  ['axial', [1, 0, 0], [0, 1, 0], 'R L A P'],
  ['coronal', [1, 0, 0], [0, 0, -1], 'R L S I'],
  ['sagittal', [0, 1, 0], [0, 0, -1], 'A P S I'],
] as const)('names the sides of an %s slice', (_, alongRow, alongColumn, letters) => {
  const edges = (['left', 'right', 'top', 'bottom'] as const).map((edge) => letterAt({ alongRow, alongColumn }, edge));
  expect(edges.join(' ')).toBe(letters);
});

it('cuts a ball in a disc, as wide as Pythagoras has it', () => {
  expect(discRadius_m(0.005, 0.003)).toBeCloseTo(0.004, 12);
  expect(discRadius_m(0.005, -0.003)).toBeCloseTo(0.004, 12);
  expect(discRadius_m(0.005, 0.005)).toBe(0);
});

it('paints a place for each step of a stroke, and none before a step is done', () => {
  expect(stroke([0, 0, 0], [0, 0.0014, 0], 0.0015)).toEqual([]);
  const places = stroke([0, 0, 0], [0, 0.004, 0], 0.0015);
  expect(places.map(([, y]) => Math.round(y * 1e6))).toEqual([1500, 3000]);
  expect(stroke([0, 0, 0], [0, 0, 0], 0.0015)).toEqual([]);
});
