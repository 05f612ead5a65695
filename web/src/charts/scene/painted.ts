/** The wall of a tract in three dimensions, each part in its colour. Loaded when it is first shown. */
import vtkCellArray from '@kitware/vtk.js/Common/Core/CellArray';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkPoints from '@kitware/vtk.js/Common/Core/Points';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import { kPerMetre, type Vec3 } from './types';
import { dispose, fit, makeWindow, paced } from './window';

export interface Wall {
  /** Edges, rising from the mouth inwards. */
  readonly depth_m: readonly number[];
  /** Edges about the axis, from the direction that the unrolled map begins with. */
  readonly angle_rad: readonly number[];
  /** Red, green, blue of each part, 0…255; [depth][angle]. */
  readonly colours: readonly (readonly Vec3[])[];
  readonly radius_m: number;
}

export interface PaintedScene {
  turn(azimuth: number, elevation: number): void;
  zoom(factor: number): void;
  reset(): void;
  resize(): void;
  destroy(): void;
}

/** A finer ring within each part, so that the wall is round. */
const kFiner = 3;

function surface({ depth_m, angle_rad, colours, radius_m }: Wall): vtkPolyData {
  const points: number[] = [],
    cells: number[] = [],
    paints: number[] = [];
  const put = (depth: number, angle: number) => {
    points.push(radius_m * kPerMetre * Math.cos(angle), radius_m * kPerMetre * Math.sin(angle), depth * kPerMetre);
    return points.length / 3 - 1;
  };
  for (let d = 0; d + 1 < depth_m.length; ++d) {
    for (let a = 0; a + 1 < angle_rad.length; ++a) {
      const colour = colours[d]?.[a] ?? [128, 128, 128];
      const from = angle_rad[a] ?? 0,
        step = ((angle_rad[a + 1] ?? 0) - from) / kFiner;
      for (let part = 0; part < kFiner; ++part) {
        const low = from + part * step,
          top = depth_m[d] ?? 0,
          end = depth_m[d + 1] ?? 0;
        cells.push(4, put(top, low), put(top, low + step), put(end, low + step), put(end, low));
        paints.push(...colour);
      }
    }
  }
  const wall = vtkPolyData.newInstance();
  const places = vtkPoints.newInstance();
  places.setData(Float32Array.from(points), 3);
  wall.setPoints(places);
  wall.setPolys(vtkCellArray.newInstance({ values: Uint32Array.from(cells) }));
  wall
    .getCellData()
    .setScalars(vtkDataArray.newInstance({ name: 'colour', numberOfComponents: 3, values: Uint8Array.from(paints) }));
  return wall;
}

/** Throws where the browser cannot draw; the caller says so on the page. */
export function makePainted(container: HTMLElement, wall: Wall): PaintedScene {
  const drawing = makeWindow(container);
  const { renderer } = drawing;
  const mapper = vtkMapper.newInstance({ scalarVisibility: true });
  mapper.setInputData(surface(wall));
  mapper.setColorModeToDirectScalars();
  mapper.setScalarModeToUseCellData();
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set({ ambient: 0.75, diffuse: 0.25 });
  renderer.addActor(actor);
  const camera = renderer.getActiveCamera();
  const render = paced(container, drawing);
  const moved = () => {
    renderer.resetCameraClippingRange();
    render();
  };
  const scene: PaintedScene = {
    turn(azimuth, elevation) {
      camera.azimuth(azimuth);
      camera.elevation(elevation);
      camera.orthogonalizeViewUp();
      moved();
    },
    zoom(factor) {
      camera.dolly(factor);
      moved();
    },
    reset() {
      const middle = (((wall.depth_m[0] ?? 0) + (wall.depth_m.at(-1) ?? 0)) / 2) * kPerMetre;
      camera.setFocalPoint(0, 0, middle);
      camera.setPosition(3, -1.4, middle - 2.2);
      camera.setViewUp(0, 0, -1);
      renderer.resetCamera();
      camera.dolly(1.35);
      moved();
    },
    resize() {
      fit(container, drawing);
      render();
    },
    destroy() {
      dispose(container, drawing);
    },
  };
  scene.resize();
  scene.reset();
  return scene;
}
