/** The way of the tip as a tube, coloured by the force at that moment, and a ball at one moment. */
import vtkCellArray from '@kitware/vtk.js/Common/Core/CellArray';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkPoints from '@kitware/vtk.js/Common/Core/Points';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import vtkTubeFilter from '@kitware/vtk.js/Filters/General/TubeFilter';
import vtkSphereSource from '@kitware/vtk.js/Filters/Sources/SphereSource';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkColorTransferFunction from '@kitware/vtk.js/Rendering/Core/ColorTransferFunction';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import { viridis } from '@/charts/colour';
import { lowerBound } from '@/charts/tiles';
import { kPerMetre, type ScenePath } from './types';

const kTube_mm = 0.13;
const kBall_mm = 0.75;
const kStops = 16;

export function makePath(path: ScenePath, most_N: number): vtkActor {
  const count = path.tip_m.length;
  const points = vtkPoints.newInstance();
  points.setData(
    Float32Array.from(path.tip_m.flatMap((p) => [p[0] * kPerMetre, p[1] * kPerMetre, p[2] * kPerMetre])),
    3,
  );
  const line = vtkPolyData.newInstance();
  line.setPoints(points);
  line.setLines(vtkCellArray.newInstance({ values: Uint32Array.from([count, ...path.tip_m.keys()]) }));
  line.getPointData().setScalars(vtkDataArray.newInstance({ name: 'force', values: Float32Array.from(path.force_N) }));

  const tube = vtkTubeFilter.newInstance({ radius: kTube_mm, numberOfSides: 6, capping: true });
  tube.setInputData(line);
  const surface = tube.getOutputData();
  surface.getPointData().setActiveScalars('force'); // the filter passes the values on, but not which ones to show
  const colours = vtkColorTransferFunction.newInstance();
  for (let stop = 0; stop <= kStops; ++stop) {
    colours.addRGBPoint((most_N * stop) / kStops, ...viridis(stop / kStops));
  }
  const mapper = vtkMapper.newInstance({ interpolateScalarsBeforeMapping: false, useLookupTableScalarRange: true });
  mapper.setLookupTable(colours);
  mapper.setScalarRange(0, most_N);
  mapper.setInputData(surface);
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set({ ambient: 0.45, diffuse: 0.55 });
  return actor;
}

/** The way of another trial: thin and in one colour, so that it stays behind the first. */
export function makeGhost(path: ScenePath): vtkActor {
  const points = vtkPoints.newInstance();
  points.setData(
    Float32Array.from(path.tip_m.flatMap((p) => [p[0] * kPerMetre, p[1] * kPerMetre, p[2] * kPerMetre])),
    3,
  );
  const line = vtkPolyData.newInstance();
  line.setPoints(points);
  line.setLines(vtkCellArray.newInstance({ values: Uint32Array.from([path.tip_m.length, ...path.tip_m.keys()]) }));
  const mapper = vtkMapper.newInstance({ scalarVisibility: false });
  mapper.setInputData(line);
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set({ ambient: 1, diffuse: 0, opacity: 0.55 });
  return actor;
}

export interface MomentBall {
  readonly actor: vtkActor;
  /** Returns whether anything moved. */
  put(t_s: number | null): boolean;
}

export function makeMoment(path: ScenePath): MomentBall {
  const source = vtkSphereSource.newInstance({ radius: kBall_mm, thetaResolution: 20, phiResolution: 14 });
  const mapper = vtkMapper.newInstance({ scalarVisibility: false });
  mapper.setInputConnection(source.getOutputPort());
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.setVisibility(false);
  let shown = -1;
  return {
    actor,
    put(t_s) {
      const at = t_s === null ? -1 : Math.min(lowerBound(path.t_s, t_s), path.t_s.length - 1);
      if (at === shown) return false;
      shown = at;
      const tip = path.tip_m[at];
      actor.setVisibility(tip !== undefined);
      if (tip) actor.setPosition(tip[0] * kPerMetre, tip[1] * kPerMetre, tip[2] * kPerMetre);
      return true;
    },
  };
}
