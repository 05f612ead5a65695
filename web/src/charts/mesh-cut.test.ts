import { describe, expect, it } from 'vitest';
import { cutLines, type RowMesh } from './mesh-cut';
import type { Vec3 } from './scene/types';

const kAround = 60,
  kRows = 61,
  kRadius_m = 0.02;

/** A sphere about a point, from its lower to its upper pole. */
function sphere([x, y, z]: Vec3): RowMesh {
  const points_m = Array.from({ length: kRows * kAround }, (_, at): Vec3 => {
    const polar = (Math.PI * Math.floor(at / kAround)) / (kRows - 1),
      turn = (2 * Math.PI * (at % kAround)) / kAround;
    const wide = kRadius_m * Math.sin(polar);
    return [x + wide * Math.cos(turn), y + wide * Math.sin(turn), z - kRadius_m * Math.cos(polar)];
  });
  return { around: kAround, points_m };
}
const kCentre: Vec3 = [0.04, 0.2, -0.06];
const fromCentre = ([x, y, z]: Vec3) => Math.hypot(x - kCentre[0], y - kCentre[1], z - kCentre[2]);

/** A wall that turns back once: two peaks above one valley, seen from the side. */
function twoPeaks(): RowMesh {
  const around = 4;
  const ring = (height: number): Vec3[] => [
    [-0.002, -0.002, height],
    [0.002, -0.002, height],
    [0.002, 0.002, height],
    [-0.002, 0.002, height],
  ];
  const pole = (height: number): Vec3[] => Array.from({ length: around }, (): Vec3 => [0, 0, height]);
  return { around, points_m: [...pole(0), ...ring(0.01), ...ring(0.004), ...ring(0.01), ...pole(0.012)] };
}

describe('a plane cuts a mesh', () => {
  it('in one closed circle, as wide as Pythagoras has it', () => {
    const mesh = sphere(kCentre);
    const lines = cutLines(mesh, { origin_m: [0, 0, kCentre[2] + 0.012], normal: [0, 0, 1] });
    expect(lines).toHaveLength(1);
    const [line = []] = lines;
    expect(line.length).toBeGreaterThan(kAround);
    expect(line.at(-1)).toEqual(line[0]);
    // √(20² − 12²) mm = 16 mm; a polyhedron of 3° lies at most 0.2 % inside its sphere.
    for (const p of line) {
      expect(p[2]).toBeCloseTo(kCentre[2] + 0.012, 12);
      expect(Math.hypot(p[0] - kCentre[0], p[1] - kCentre[1])).toBeCloseTo(0.016, 4);
    }
  });
  it('also where the plane goes through both poles and along edges', () => {
    const lines = cutLines(sphere(kCentre), { origin_m: kCentre, normal: [0, 1, 0] });
    expect(lines).toHaveLength(1);
    expect(lines[0]?.at(-1)).toEqual(lines[0]?.[0]);
    for (const p of lines[0] ?? []) expect(fromCentre(p)).toBeCloseTo(kRadius_m, 4);
  });
  it('round once: the line is as long as the circle', () => {
    const [line = []] = cutLines(sphere(kCentre), { origin_m: kCentre, normal: [0.6, 0, 0.8] });
    const length = line.slice(1).reduce((total, p, i) => {
      const before = line[i] ?? p;
      return total + Math.hypot(p[0] - before[0], p[1] - before[1], p[2] - before[2]);
    }, 0);
    expect(length / (2 * Math.PI * kRadius_m)).toBeCloseTo(1, 2);
  });
  it('in a line for each time that the mesh passes through it', () => {
    const lines = cutLines(twoPeaks(), { origin_m: [0, 0, 0.007], normal: [0, 0, 1] });
    expect(lines).toHaveLength(3); // the cone below, the wall inwards and the wall outwards
    for (const line of lines) expect(line.at(-1)).toEqual(line[0]);
  });
  it('nowhere, if it passes the mesh by or if there is no mesh', () => {
    const beyond = { origin_m: [0, 0, 1], normal: [0, 0, 1] } as const;
    expect(cutLines(sphere(kCentre), beyond)).toEqual([]);
    expect(cutLines({ around: 0, points_m: [] }, beyond)).toEqual([]);
  });
});
