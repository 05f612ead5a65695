#include "station/view/scene_parts.hpp"

#include <vtkActor.h>
#include <vtkColorTransferFunction.h>
#include <vtkCylinderSource.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkMatrix4x4.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPlane.h>
#include <vtkPlaneCollection.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRegularPolygonSource.h>
#include <vtkSphereSource.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedShortArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cmath>

namespace tractus {
namespace view {
namespace {

constexpr int kShankPieces = 40;

vtkSmartPointer<vtkActor> actor_of(vtkAlgorithmOutput* shape, std::array<double, 3> colour) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(shape);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(colour.data());
  return actor;
}

/// A polyline through the points, replacing what `line` held.
void set_line(vtkPolyData& line, std::span<const math::Vec3> points_m) {
  const auto count = static_cast<vtkIdType>(points_m.size());
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  points->SetNumberOfPoints(count);
  if (count > 1) cells->InsertNextCell(static_cast<int>(count));
  for (vtkIdType id = 0; id < count; ++id) {
    points->SetPoint(id, points_m[static_cast<std::size_t>(id)].data());
    if (count > 1) cells->InsertCellPoint(id);
  }
  line.SetPoints(points);
  line.SetLines(cells);
  line.Modified();
}

/// Matrix that takes (y axis of a VTK source) to `axis` at `centre`.
vtkSmartPointer<vtkMatrix4x4> placed(const math::Vec3& centre, const math::Vec3& axis) {
  const math::Mat3 R = math::Quat::FromTwoVectors(math::Vec3::UnitY(), axis).toRotationMatrix();
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) matrix->SetElement(r, c, R(r, c));
    matrix->SetElement(r, 3, centre[r]);
  }
  return matrix;
}

vtkSmartPointer<vtkImageData> image_of(const volume::Volume& volume) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  const auto& g = volume.geometry;
  image->SetDimensions(g.dims[0], g.dims[1], g.dims[2]);
  image->SetSpacing(g.spacing_m.data());
  vtkNew<vtkUnsignedShortArray> counts;
  counts->SetNumberOfValues(static_cast<vtkIdType>(volume.counts.size()));
  std::copy(volume.counts.begin(), volume.counts.end(), counts->GetPointer(0));
  image->GetPointData()->SetScalars(counts);
  return image;
}

void colour_bone(vtkVolumeProperty& property, const Scene& scene) {
  const auto count = [&](double value) {
    return (value - scene.volume.intercept) / scene.volume.slope;
  };
  vtkNew<vtkPiecewiseFunction> opacity;
  for (const auto& point : scene.transfer.points())
    opacity->AddPoint(count(point.value), 0.9 * point.opacity);
  vtkNew<vtkColorTransferFunction> colour;
  const double low = scene.transfer.points().front().value,
               high = scene.transfer.points().back().value;
  colour->AddRGBPoint(count(low), 0.72, 0.52, 0.42);
  colour->AddRGBPoint(count(0.5 * (low + high)), 0.90, 0.80, 0.66);
  colour->AddRGBPoint(count(high), 0.98, 0.96, 0.90);
  property.SetScalarOpacity(opacity);
  property.SetColor(colour);
  property.SetInterpolationTypeToLinear();
  property.ShadeOn();
  property.SetAmbient(0.4);
  property.SetDiffuse(0.65);
  property.SetSpecular(0.15);
  property.SetScalarOpacityUnitDistance(scene.volume.geometry.spacing_m.minCoeff());
}

/// Where the voxels of an image lie whose frame is that of the volume's indices times spacing.
vtkSmartPointer<vtkMatrix4x4> placed_as(const volume::Geometry& geometry) {
  auto X_VI = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) X_VI->SetElement(r, c, geometry.directions(r, c));
    X_VI->SetElement(r, 3, geometry.origin_m[r]);
  }
  return X_VI;
}

}  // namespace

void Bone::add(vtkRenderer& renderer, const Scene& scene) {
  const double voxel_m = scene.volume.geometry.spacing_m.minCoeff();
  vtkNew<vtkGPUVolumeRayCastMapper> mapper;
  image_ = image_of(scene.volume);
  mapper->SetInputData(image_);
  mapper->SetAutoAdjustSampleDistances(0);
  mapper->SetSampleDistance(static_cast<float>(0.7 * voxel_m));
  mapper->UseJitteringOn();
  vtkNew<vtkPlane> cut;
  const math::Vec3 away = -scene.tract.medial;
  cut->SetOrigin(scene.tract.entry_m.x(), scene.tract.entry_m.y(), scene.tract.entry_m.z());
  cut->SetNormal(away.x(), away.y(), away.z());
  vtkNew<vtkPlaneCollection> planes;
  planes->AddItem(cut);
  mapper->SetClippingPlanes(planes);

  vtkNew<vtkVolume> bone;
  bone->SetMapper(mapper);
  colour_bone(*bone->GetProperty(), scene);
  bone->SetUserMatrix(placed_as(scene.volume.geometry));
  renderer.AddVolume(bone);
}

void Bone::carve_away(const volume::Box& box, const volume::Volume& volume) {
  if (box.begin[0] >= box.end[0]) return;
  auto* counts = vtkUnsignedShortArray::SafeDownCast(image_->GetPointData()->GetScalars());
  const auto width = static_cast<std::ptrdiff_t>(box.end[0] - box.begin[0]);
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      const auto at = static_cast<std::ptrdiff_t>(volume.offset(box.begin[0], j, k));
      std::copy_n(volume.counts.begin() + at, width, counts->GetPointer(at));
    }
  counts->Modified();
  image_->Modified();
}

void PilotHoleSurface::add(vtkRenderer& renderer, const Scene& scene) {
  geometry_ = scene.volume.geometry;
  lost_ = vtkSmartPointer<vtkImageData>::New();
  vtkNew<vtkFlyingEdges3D> surface;
  surface->SetInputData(lost_);
  surface->SetValue(0, 0.5);
  surface->ComputeScalarsOff();
  actor_ = actor_of(surface->GetOutputPort(), kDrilled);
  actor_->GetProperty()->FrontfaceCullingOn();
  actor_->GetProperty()->SetAmbient(0.25);
  actor_->GetProperty()->SetDiffuse(0.75);
  renderer.AddActor(actor_);
  show(scene.worn ? *scene.worn : drilling::ErodedShares{});
}

void PilotHoleSurface::show(const drilling::ErodedShares& worn) {
  actor_->SetVisibility(!worn.lost.empty());
  if (worn.lost.empty()) return;
  // A voxel without loss all about, so that the surface is closed. The frame is made right-handed:
  // which side of a triangle is out goes by the order of its corners.
  const bool mirrored = geometry_.directions.determinant() < 0.0;
  volume::Geometry frame = geometry_;
  if (mirrored) frame.directions.col(2) *= -1.0;
  std::array<int, 3> size{}, first{};
  for (std::size_t a = 0; a < 3; ++a) {
    size[a] = worn.box.end[a] - worn.box.begin[a];
    first[a] = mirrored && a == 2 ? -worn.box.end[a] : worn.box.begin[a] - 1;
  }
  lost_->SetDimensions(size[0] + 2, size[1] + 2, size[2] + 2);
  lost_->SetSpacing(frame.spacing_m.data());
  lost_->SetOrigin(first[0] * frame.spacing_m[0], first[1] * frame.spacing_m[1],
                   first[2] * frame.spacing_m[2]);
  vtkNew<vtkFloatArray> lost;
  lost->SetNumberOfValues(lost_->GetNumberOfPoints());
  lost->FillValue(0.0F);
  auto from = worn.lost.begin();
  for (int k = 0; k < size[2]; ++k)
    for (int j = 0; j < size[1]; ++j, from += size[0]) {
      const int plane = mirrored ? size[2] - k : k + 1;
      const vtkIdType row = (vtkIdType(plane) * (size[1] + 2) + j + 1) * (size[0] + 2) + 1;
      std::copy_n(from, size[0], lost->GetPointer(row));
    }
  lost_->GetPointData()->SetScalars(lost);
  actor_->SetUserMatrix(placed_as(frame));
}

void TractOutline::add(vtkRenderer& renderer, const volume::Tract& tract) {
  for (int k = 0; k <= 4; ++k) {
    vtkNew<vtkRegularPolygonSource> ring;
    const math::Vec3 centre = tract.entry_m + tract.axis * (tract.length_m * k / 4.0);
    ring->SetCenter(centre.x(), centre.y(), centre.z());
    ring->SetNormal(tract.axis.x(), tract.axis.y(), tract.axis.z());
    ring->SetRadius(tract.radius_m);
    ring->SetNumberOfSides(48);
    ring->GeneratePolygonOff();
    auto actor = actor_of(ring->GetOutputPort(), kPlanned);
    actor->GetProperty()->SetLineWidth(2.0F);
    actor->GetProperty()->LightingOff();
    renderer.AddActor(actor);
  }
}

void Shank::add(vtkRenderer& renderer, const Scene& scene) {
  const laws::PalpationParameters& probe = probe_ = scene.probe;
  if (scene.burr) nose_m_ = scene.burr->nose_m;
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputData(curve_);
  tube->SetRadius(probe.radius_m);
  tube->SetNumberOfSides(12);
  tube->CappingOn();
  renderer.AddActor(actor_of(tube->GetOutputPort(), {0.75, 0.78, 0.82}));
  for (int i = 0; i < (scene.burr ? 1 : probe.points); ++i) {
    vtkNew<vtkSphereSource> ball;
    ball->SetRadius(scene.burr ? scene.burr->radius_m : 1.4 * probe.radius_m);
    ball->SetThetaResolution(24);
    ball->SetPhiResolution(24);
    points_.push_back(actor_of(ball->GetOutputPort(), kTouches));
    renderer.AddActor(points_.back());
  }
  vtkNew<vtkCylinderSource> grip;
  grip->SetRadius(0.006);
  grip->SetHeight(0.05);
  grip->SetResolution(24);
  handle_ = actor_of(grip->GetOutputPort(), {0.25, 0.32, 0.40});
  renderer.AddActor(handle_);
}

void Shank::pose(const ProbeState& state) {
  const double L = probe_.length_m;
  const auto on_shank = [&](double z) {
    const double shape = z * z * (3 * L - z) / (2 * L * L * L);  // φ(z), laws/palpation_law.hpp
    return state.X_VH *
           math::Vec3(shape * state.deflection_m.x(), shape * state.deflection_m.y(), z);
  };
  std::vector<math::Vec3> curve;
  const math::Vec3 axis = state.X_VH.q * math::Vec3::UnitZ();
  for (int k = 0; k < kShankPieces; ++k) curve.push_back(on_shank(L * k / kShankPieces));
  curve.push_back(on_shank(L) - nose_m_ * axis);  // a burr's centre, as drilling::Erosion has it
  set_line(*curve_, curve);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double back_m = static_cast<double>(i) * probe_.point_spacing_m;
    const math::Vec3 p = i == 0 ? curve.back() : on_shank(L - back_m);
    points_[i]->SetPosition(p.x(), p.y(), p.z());
  }
  handle_->SetUserMatrix(placed(state.X_VH.p - 0.025 * axis, axis));
}

void TipPath::add(vtkRenderer& renderer) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(line_);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(kWay[0], kWay[1], kWay[2]);
  actor->GetProperty()->SetLineWidth(1.2F);
  actor->GetProperty()->LightingOff();
  renderer.AddActor(actor);
}

void TipPath::points(std::span<const math::Vec3> path_m) { set_line(*line_, path_m); }

void Picture::add(vtkRenderer& renderer, const Scene& scene) {
  renderer.SetBackground(0.09, 0.10, 0.12);
  bone_.add(renderer, scene);
  channel_.add(renderer, scene);
  outline_.add(renderer, scene.tract);
  path_.add(renderer);
  shank_.add(renderer, scene);
}

}  // namespace view
}  // namespace tractus
