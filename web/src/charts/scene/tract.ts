/** The channel as drawn by its maker: a clear cylinder. */
import vtkCylinderSource from '@kitware/vtk.js/Filters/Sources/CylinderSource';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import { kPerMetre, scaled, sum, type SceneTract } from './types';

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
