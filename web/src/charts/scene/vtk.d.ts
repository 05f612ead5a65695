/** What vtk.js ships without types, as far as it is used here. */
declare module '@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry';

declare module '@kitware/vtk.js/Filters/General/ImageMarchingCubes' {
  import type vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
  interface MarchingCubes {
    setInputData(image: unknown): void;
    getOutputData(): vtkPolyData;
    delete(): void;
  }
  const factory: {
    newInstance(values: { contourValue: number; computeNormals: boolean; mergePoints: boolean }): MarchingCubes;
  };
  export default factory;
}
