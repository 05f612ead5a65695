/** The channel as drawn by its maker: a clear cylinder. */
import vtkCylinderSource from '@kitware/vtk.js/Filters/Sources/CylinderSource';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import { kPerMetre, scaled, sum, type SceneBreach, type SceneTract } from './types';

export function makeTract(tract: SceneTract): vtkActor {
  const middle = sum(scaled(tract.entry_m), scaled(tract.axis, (tract.length_m / 2) * kPerMetre));
  const source = vtkCylinderSource.newInstance({
    height: tract.length_m * kPerMetre,
    radius: tract.radius_m * kPerMetre,
    resolution: 48,
    capping: false,
    center: [middle[0], middle[1], middle[2]],
    direction: [tract.axis[0], tract.axis[1], tract.axis[2]],
  });
  const mapper = vtkMapper.newInstance({ scalarVisibility: false });
  mapper.setInputConnection(source.getOutputPort());
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set({ opacity: 0.14, ambient: 0.6, diffuse: 0.4 });
  return actor;
}

/** Where the tool leaves the channel: a solid cylinder as wide as the channel, from its axis to the farthest point. */
export function makeBreach({ from_m, tip_m }: SceneBreach, radius_m: number): vtkActor {
  const along = sum(scaled(tip_m), scaled(from_m, -kPerMetre));
  const middle = sum(scaled(from_m, kPerMetre / 2), scaled(tip_m, kPerMetre / 2));
  const source = vtkCylinderSource.newInstance({
    height: Math.hypot(...along),
    radius: radius_m * kPerMetre,
    resolution: 32,
    capping: true,
    center: [middle[0], middle[1], middle[2]],
    direction: [along[0], along[1], along[2]],
  });
  const mapper = vtkMapper.newInstance({ scalarVisibility: false });
  mapper.setInputConnection(source.getOutputPort());
  const actor = vtkActor.newInstance();
  actor.setMapper(mapper);
  actor.getProperty().set({ ambient: 0.4, diffuse: 0.6 });
  return actor;
}
