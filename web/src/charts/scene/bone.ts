/** The bone as a surface of equal opacity, with a half cut away to open the channel, and the cut filled with the CT. */
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkImageData from '@kitware/vtk.js/Common/DataModel/ImageData';
import vtkPlane from '@kitware/vtk.js/Common/DataModel/Plane';
import type vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import vtkImageMarchingCubes from '@kitware/vtk.js/Filters/General/ImageMarchingCubes';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import { makeSlice } from './slice';
import { withoutSpecks } from './specks';
import { kPerMetre, scaled, type SceneBone, type SceneTract, type Vec3 } from './types';

/** A tenth of full opacity: where bone begins to resist. The cancellous inside of a vertebra hardly reaches a half. */
const kSurface = 25.5;

/** Points and normals from the grid's own axes into the patient's frame. */
function place(surface: vtkPolyData, bone: SceneBone): void {
  const d = bone.directions;
  const turn = (values: ArrayLike<number> & { [index: number]: number }, origin: Vec3) => {
    for (let at = 0; at + 2 < values.length; at += 3) {
      const [x, y, z] = [values[at] ?? 0, values[at + 1] ?? 0, values[at + 2] ?? 0];
      for (const row of [0, 1, 2] as const) {
        values[at + row] = (d[3 * row] ?? 0) * x + (d[3 * row + 1] ?? 0) * y + (d[3 * row + 2] ?? 0) * z + origin[row];
      }
    }
  };
  turn(surface.getPoints().getData() as Float32Array, scaled(bone.origin_m));
  const normals = surface.getPointData().getNormals();
  if (normals) turn(normals.getData() as Float32Array, [0, 0, 0]);
}

function surfaceOf(bone: SceneBone): vtkPolyData {
  const image = vtkImageData.newInstance();
  image.setDimensions([bone.dims[0], bone.dims[1], bone.dims[2]]);
  image.setSpacing([...scaled(bone.spacing_m)] as [number, number, number]);
  image.getPointData().setScalars(
    vtkDataArray.newInstance({
      name: 'opacity',
      numberOfComponents: 1,
      values: withoutSpecks(bone.opacity, bone.dims, kSurface),
    }),
  );
  const cubes = vtkImageMarchingCubes.newInstance({ contourValue: kSurface, computeNormals: true, mergePoints: true });
  cubes.setInputData(image);
  const surface = cubes.getOutputData();
  place(surface, bone);
  return surface;
}

export interface BoneActor {
  readonly actors: readonly vtkActor[];
  show(visible: boolean, cut: boolean): void;
  colour(colour: Vec3): void;
}

export function makeBone(bone: SceneBone, tract: SceneTract): BoneActor {
  const mapper = vtkMapper.newInstance({ scalarVisibility: false });
  mapper.setInputData(surfaceOf(bone));
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set({ ambient: 0.18, diffuse: 0.82, specular: 0.08, specularPower: 12 });
  // What lies to superior of the axis goes, so that the view from above looks into the channel.
  const plane = vtkPlane.newInstance({
    origin: [...scaled(tract.entry_m, kPerMetre)] as [number, number, number],
    normal: [...scaled(tract.superior, -1)] as [number, number, number],
  });
  const slice = makeSlice(bone, tract);
  return {
    actors: [actor, slice],
    show: (visible, cut) => {
      actor.setVisibility(visible);
      slice.setVisibility(visible && cut);
      mapper.removeAllClippingPlanes();
      if (cut) mapper.addClippingPlane(plane);
    },
    colour: (colour) => {
      actor.getProperty().setColor(colour[0], colour[1], colour[2]);
    },
  };
}
