/** The CT on the plane of the cut: the bone's opacity sampled where the half was taken away. */
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkImageData from '@kitware/vtk.js/Common/DataModel/ImageData';
import vtkPlaneSource from '@kitware/vtk.js/Filters/Sources/PlaneSource';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import vtkTexture from '@kitware/vtk.js/Rendering/Core/Texture';
import { dot, scaled, sum, type SceneBone, type SceneTract, type Vec3 } from './types';

const kPixels = 320;
/** Opacities between which the cut fades in: below there is no bone. */
const kClear = 6,
  kSolid = 26;

/** Opacity 0…255 at a point of the patient's frame, trilinear; 0 outside the grid. */
export function opacityAt(bone: SceneBone, p_m: Vec3): number {
  const d = bone.directions;
  const from = sum(p_m, scaled(bone.origin_m, -1));
  const at = ([0, 1, 2] as const).map(
    (axis) => dot([d[axis] ?? 0, d[3 + axis] ?? 0, d[6 + axis] ?? 0], from) / bone.spacing_m[axis],
  );
  const [i = 0, j = 0, k = 0] = at.map(Math.floor);
  const [nx, ny, nz] = bone.dims;
  if (i < 0 || j < 0 || k < 0 || i + 1 >= nx || j + 1 >= ny || k + 1 >= nz) return 0;
  const [u, v, w] = [(at[0] ?? 0) - i, (at[1] ?? 0) - j, (at[2] ?? 0) - k];
  let total = 0;
  for (const [dk, sk] of [
    [0, 1 - w],
    [1, w],
  ] as const) {
    for (const [dj, sj] of [
      [0, 1 - v],
      [1, v],
    ] as const) {
      for (const [di, si] of [
        [0, 1 - u],
        [1, u],
      ] as const) {
        total += sk * sj * si * (bone.opacity[((k + dk) * ny + j + dj) * nx + i + di] ?? 0);
      }
    }
  }
  return total;
}

/** The square of the plane that holds the whole grid, about the middle of the tract. */
function square(bone: SceneBone, tract: SceneTract): { corner: Vec3; along: Vec3; across: Vec3 } {
  const middle = sum(tract.entry_m, scaled(tract.axis, tract.length_m / 2));
  const side = Math.max(...([0, 1, 2] as const).map((axis) => bone.dims[axis] * bone.spacing_m[axis])) * 1.5;
  const along = scaled(tract.axis, side),
    across = scaled(tract.medial, side);
  return { corner: sum(middle, scaled(along, -0.5), scaled(across, -0.5)), along, across };
}

export function makeSlice(bone: SceneBone, tract: SceneTract): vtkActor {
  const { corner, along, across } = square(bone, tract);
  const pixels = new Uint8Array(kPixels * kPixels * 4);
  for (let row = 0, at = 0; row < kPixels; ++row) {
    for (let column = 0; column < kPixels; ++column, at += 4) {
      const value = opacityAt(
        bone,
        sum(corner, scaled(along, (column + 0.5) / kPixels), scaled(across, (row + 0.5) / kPixels)),
      );
      pixels.fill(70 + Math.round(175 * Math.sqrt(value / 255)), at, at + 3);
      pixels[at + 3] = 255 * Math.min(Math.max((value - kClear) / (kSolid - kClear), 0), 1);
    }
  }
  const image = vtkImageData.newInstance();
  image.setDimensions([kPixels, kPixels, 1]);
  image.getPointData().setScalars(vtkDataArray.newInstance({ name: 'slice', numberOfComponents: 4, values: pixels }));
  const texture = vtkTexture.newInstance({ interpolate: true });
  texture.setInputData(image);
  const plane = vtkPlaneSource.newInstance({ xResolution: 1, yResolution: 1 });
  plane.setOrigin([...scaled(corner)]);
  plane.setPoint1([...scaled(sum(corner, along))]);
  plane.setPoint2([...scaled(sum(corner, across))]);
  const mapper = vtkMapper.newInstance({ scalarVisibility: false });
  mapper.setInputConnection(plane.getOutputPort());
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.addTexture(texture);
  actor.getProperty().set({ ambient: 1, diffuse: 0 });
  actor.setForceTranslucent(true);
  return actor;
}
