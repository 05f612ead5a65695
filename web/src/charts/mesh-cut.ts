/** The lines along which a plane cuts a closed mesh. */
import { dot, scaled, sum, type Vec3 } from './scene/types';

/** Points row by row, `around` a row; the last of a row joins the first. All points of the first and the last row lie at a pole. */
export interface RowMesh {
  readonly around: number;
  readonly points_m: readonly Vec3[];
}
export interface CutPlane {
  readonly origin_m: Vec3;
  readonly normal: Vec3;
}
/** The first point is repeated as the last where the line is closed. */
export type CutLine = readonly Vec3[];

type Triangle = readonly [number, number, number];

function trianglesOf({ around, points_m }: RowMesh): Triangle[] {
  const out: Triangle[] = [];
  const rows = around > 2 ? Math.floor(points_m.length / around) : 0;
  for (let row = 0; row + 1 < rows; ++row) {
    for (let i = 0; i < around; ++i) {
      const next = (i + 1) % around;
      const a = row * around + i,
        b = row * around + next;
      out.push([a, b, a + around], [b, b + around, a + around]);
    }
  }
  return out;
}

/** Each edge that the plane cuts, by a key, with the edges that it is joined to within a triangle. */
function joinedEdges(mesh: RowMesh, height_m: readonly number[]): Map<number, number[]> {
  const above = (i: number) => (height_m[i] ?? 0) >= 0;
  const key = (i: number, k: number) => Math.min(i, k) * mesh.points_m.length + Math.max(i, k);
  const joined = new Map<number, number[]>();
  const join = (from: number, to: number) => joined.set(from, [...(joined.get(from) ?? []), to]);
  for (const [a, b, c] of trianglesOf(mesh)) {
    const [one, other] = (
      [
        [a, b],
        [b, c],
        [c, a],
      ] as const
    )
      .filter(([i, k]) => above(i) !== above(k))
      .map(([i, k]) => key(i, k));
    if (one === undefined || other === undefined) continue;
    join(one, other);
    join(other, one);
  }
  return joined;
}

/** Takes one line out of the edges that are left: round until it is back, or to an end. */
function takeLine(joined: Map<number, number[]>, first: number): number[] {
  const line = [first];
  for (let at: number | undefined = first; at !== undefined;) {
    const next: number | undefined = joined.get(at)?.find((edge) => joined.has(edge));
    joined.delete(at);
    if (next !== undefined) line.push(next);
    at = next;
  }
  return line;
}

/** The outlines of a mesh in a plane: none where the plane passes it by. */
export function cutLines(mesh: RowMesh, { origin_m, normal }: CutPlane): CutLine[] {
  const { points_m } = mesh;
  const height_m = points_m.map((p) => dot(sum(p, scaled(origin_m, -1)), normal));
  const pointOn = (edge: number): Vec3 => {
    const low = Math.floor(edge / points_m.length),
      high = edge % points_m.length;
    const from = points_m[low] ?? origin_m,
      to = points_m[high] ?? origin_m;
    const share = (height_m[low] ?? 0) / ((height_m[low] ?? 0) - (height_m[high] ?? 0));
    return sum(from, scaled(sum(to, scaled(from, -1)), share));
  };
  const joined = joinedEdges(mesh, height_m);
  const lines: CutLine[] = [];
  for (const first of [...joined.keys()]) {
    const neighbours = joined.get(first);
    if (!neighbours) continue;
    const edges = takeLine(joined, first);
    const last = edges.at(-1) ?? first;
    const closed = edges.length > 2 && neighbours.includes(last);
    lines.push((closed ? [...edges, first] : edges).map(pointOn));
  }
  return lines;
}
