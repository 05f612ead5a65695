import { expect, it } from 'vitest';
import { letterAt } from './slice-places';

// As server/api/volumes/volume_pictures.hpp has the planes: LPS along a row and down a column.
it.each([
  ['axial', [1, 0, 0], [0, 1, 0], 'R L A P'],
  ['coronal', [1, 0, 0], [0, 0, -1], 'R L S I'],
  ['sagittal', [0, 1, 0], [0, 0, -1], 'A P S I'],
] as const)('names the sides of an %s slice', (_, alongRow, alongColumn, letters) => {
  const edges = (['left', 'right', 'top', 'bottom'] as const).map((edge) => letterAt({ alongRow, alongColumn }, edge));
  expect(edges.join(' ')).toBe(letters);
});
