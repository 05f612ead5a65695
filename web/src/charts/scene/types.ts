export type Vec3 = readonly [number, number, number];

/** The channel in the patient's frame, SI. */
export interface SceneTract {
  readonly entry_m: Vec3;
  readonly axis: Vec3;
  readonly length_m: number;
  readonly radius_m: number;
  readonly medial: Vec3;
  readonly superior: Vec3;
}

export interface ScenePath {
  readonly t_s: readonly number[];
  readonly tip_m: readonly Vec3[];
  readonly force_N: readonly number[];
}

/** Opacities of the bone on a grid in the patient's frame. */
export interface SceneBone {
  readonly dims: Vec3;
  readonly spacing_m: Vec3;
  readonly origin_m: Vec3;
  /** Row-major; columns are the directions of i, j, k. */
  readonly directions: readonly number[];
  /** [k][j][i], 0…255 */
  readonly opacity: Uint8Array;
}

/** A capsule from the tract's axis to beyond a wall. */
export interface SceneBreach {
  readonly from_m: Vec3;
  readonly tip_m: Vec3;
}

export interface SceneColours {
  readonly bone: Vec3;
  readonly tract: Vec3;
  readonly moment: Vec3;
  readonly ghost?: Vec3;
}

export type ViewName = 'start' | 'medial' | 'superior' | 'along';

/** The scene is built in millimetres: the renderer's tolerances are made for numbers near one. */
export const kPerMetre = 1000;
export const scaled = (a: Vec3, by = kPerMetre): Vec3 => [a[0] * by, a[1] * by, a[2] * by];
export const sum = (...all: Vec3[]): Vec3 =>
  all.reduce<Vec3>((total, a) => [total[0] + a[0], total[1] + a[1], total[2] + a[2]], [0, 0, 0]);
export const dot = (a: Vec3, b: Vec3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
