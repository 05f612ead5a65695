#include "volume/io/write_surface.hpp"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkReverseSense.h>
#include <vtkSTLWriter.h>
#include <vtkTriangleFilter.h>
#include <vtkTubeFilter.h>

#include "core/try.hpp"
#include "volume/io/vtk_quiet.hpp"

namespace tractus {
namespace volume_io {
namespace {

constexpr int kSides = 48;
constexpr double kMillimetres = 1e3;  // per metre

/// CT values on a grid of voxel indices: the geometry comes after, since it may be left-handed.
vtkNew<vtkImageData> image_of(const volume::Volume& volume) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(volume.geometry.dims.data());
  vtkNew<vtkFloatArray> values;
  values->SetNumberOfTuples(static_cast<vtkIdType>(volume.counts.size()));
  float* at = values->GetPointer(0);
  for (const auto count : volume.counts)
    *at++ = static_cast<float>(volume.intercept + volume.slope * count);
  image->GetPointData()->SetScalars(values);
  return image;
}

void place(vtkPoints& points, const volume::Geometry& geometry) {
  for (vtkIdType k = 0; k < points.GetNumberOfPoints(); ++k) {
    volume::Vec3 index;
    points.GetPoint(k, index.data());
    const volume::Vec3 at_mm = geometry.position_of(index) * kMillimetres;
    points.SetPoint(k, at_mm.data());
  }
}

/// 3D Slicer reads the space from the header.
core::Result<void> write_stl(const std::filesystem::path& path, vtkPolyData* surface) {
  vtkNew<vtkSTLWriter> writer;
  const VtkErrors errors(writer);
  writer->SetFileName(path.c_str());
  writer->SetFileTypeToBinary();
  writer->SetHeader("tractus; SPACE=LPS; millimetres");
  writer->SetInputData(surface);
  if (writer->Write() == 0 || !errors.first().empty())
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot be written: {}", path.string(), errors.first())};
  return {};
}

}  // namespace

core::Result<std::size_t> write_bone_stl(const std::filesystem::path& path,
                                         const volume::Volume& volume, double value) {
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(image_of(volume));
  edges->SetValue(0, value);
  edges->ComputeNormalsOff();
  edges->ComputeGradientsOff();
  edges->ComputeScalarsOff();
  edges->Update();
  vtkNew<vtkPolyData> surface;
  surface->ShallowCopy(edges->GetOutput());
  if (surface->GetNumberOfPolys() == 0)
    return core::Error{core::Errc::out_of_range,
                       fmt::format("no surface lies at the CT value {:g}", value)};
  place(*surface->GetPoints(), volume.geometry);
  if (volume.geometry.directions.determinant() < 0.0) {
    vtkNew<vtkReverseSense> reverse;
    reverse->SetInputData(surface);
    reverse->Update();
    surface->ShallowCopy(reverse->GetOutput());
  }
  TRY(write_stl(path, surface));
  return static_cast<std::size_t>(surface->GetNumberOfPolys());
}

core::Result<void> write_tract_stl(const std::filesystem::path& path, const volume::Tract& tract) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const volume::Vec3& end_m : {tract.entry_m, tract.end_m()}) {
    const volume::Vec3 end_mm = end_m * kMillimetres;
    points->InsertNextPoint(end_mm.data());
  }
  vtkNew<vtkCellArray> line;
  const vtkIdType ends[] = {0, 1};
  line->InsertNextCell(2, ends);
  vtkNew<vtkPolyData> axis;
  axis->SetPoints(points);
  axis->SetLines(line);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputData(axis);
  tube->SetRadius(tract.radius_m * kMillimetres);
  tube->SetNumberOfSides(kSides);
  tube->CappingOn();
  vtkNew<vtkTriangleFilter> triangles;
  triangles->SetInputConnection(tube->GetOutputPort());
  triangles->Update();
  return write_stl(path, triangles->GetOutput());
}

}  // namespace volume_io
}  // namespace tractus
