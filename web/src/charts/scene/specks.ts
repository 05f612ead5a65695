/** Specks of a picture in voxels: noise, calcified vessels and the table, which are no bone that anyone asks for. */

const kSpeck_share = 0.01;

/** Each voxel's part, counted from 1, 0 below `surface`, and how many voxels each part has. Parts touch by faces. */
function partsOf(opacity: Uint8Array, dims: readonly [number, number, number], surface: number) {
  const [nx, ny] = dims;
  const part = new Int32Array(opacity.length);
  const sizes = [0];
  const waiting = new Int32Array(opacity.length);
  for (let seed = 0; seed < opacity.length; ++seed) {
    if ((opacity[seed] ?? 0) < surface || part[seed] !== 0) continue;
    const label = sizes.length;
    let end = 0,
      voxels = 0;
    const visit = (at: number) => {
      if ((opacity[at] ?? 0) < surface || part[at] !== 0) return;
      part[at] = label;
      waiting[end] = at;
      end += 1;
    };
    visit(seed);
    while (voxels < end) {
      const at = waiting[voxels] ?? 0;
      voxels += 1;
      const i = at % nx,
        j = Math.floor(at / nx) % ny;
      if (i > 0) visit(at - 1);
      if (i + 1 < nx) visit(at + 1);
      if (j > 0) visit(at - nx);
      if (j + 1 < ny) visit(at + nx);
      if (at >= nx * ny) visit(at - nx * ny);
      if (at + nx * ny < opacity.length) visit(at + nx * ny);
    }
    sizes.push(voxels);
  }
  return { part, sizes };
}

/** The same opacity, with parts of the bone that have under a hundredth of the largest one's voxels cleared away. */
export function withoutSpecks(
  opacity: Uint8Array,
  dims: readonly [number, number, number],
  surface: number,
): Uint8Array {
  const { part, sizes } = partsOf(opacity, dims, surface);
  const least = kSpeck_share * sizes.reduce((most, n) => Math.max(most, n), 0);
  return opacity.map((value, at) => {
    const label = part[at] ?? 0;
    return label !== 0 && (sizes[label] ?? 0) < least ? 0 : value;
  });
}
