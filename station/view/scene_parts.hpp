/// The things in the picture, each with the VTK objects it needs. Lengths in metres, as everywhere.
#pragma once

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <array>
#include <span>
#include <vector>

#include "station/view/view.hpp"

class vtkActor;
class vtkImageData;

namespace tractus::view {

// Told apart from bone, from the dark behind it and from one another by the colour-blind too: a
// light blue, a purple, a yellow and a red that differ in lightness.
inline constexpr std::array kPlanned{0.45, 0.85, 1.0}, kDrilled{0.80, 0.32, 0.86},
    kWay{1.0, 0.82, 0.30}, kTouches{0.95, 0.35, 0.25};

/// The bone: volume rendering of opacity and CT value, the half towards the eye cut away.
class Bone {
 public:
  void add(vtkRenderer& renderer, const Scene& scene);
  /// Takes the counts of `box` anew.
  void carve_away(const volume::Box& box, const volume::Volume& volume);

 private:
  vtkSmartPointer<vtkImageData> image_;
};

/// What a burr has taken: the surface about the voxels that lost half of themselves or more, marrow
/// without opacity too. The side towards the eye is left out, so that one looks in.
class PilotHoleSurface {
 public:
  void add(vtkRenderer& renderer, const Scene& scene);
  void show(const drilling::ErodedShares& worn);

 private:
  vtkSmartPointer<vtkImageData> lost_;
  vtkSmartPointer<vtkActor> actor_;
  volume::Geometry geometry_;
};

/// The tract: rings and its axis.
class TractOutline {
 public:
  void add(vtkRenderer& renderer, const volume::Tract& tract);
};

/// The tool: handle, bent shank, and the probe's contact points or the burr's ball.
class Shank {
 public:
  void add(vtkRenderer& renderer, const Scene& scene);
  void pose(const ProbeState& state);

 private:
  laws::PalpationParameters probe_;
  double nose_m_ = 0.0;  // of a burr
  vtkNew<vtkPolyData> curve_;
  std::vector<vtkSmartPointer<vtkActor>> points_;
  vtkSmartPointer<vtkActor> handle_;
};

/// Where the tip has been.
class TipPath {
 public:
  void add(vtkRenderer& renderer);
  void points(std::span<const math::Vec3> path_m);

 private:
  vtkNew<vtkPolyData> line_;
};

/// All of it, in whatever renderer draws: the window's, the off-screen one's, the headset's eyes'.
class Picture {
 public:
  void add(vtkRenderer& renderer, const Scene& scene);
  void pose(const ProbeState& state) { shank_.pose(state); }
  void path(std::span<const math::Vec3> path_m) { path_.points(path_m); }
  void carve_away(const volume::Box& box, const volume::Volume& volume,
                  const drilling::ErodedShares& worn) {
    bone_.carve_away(box, volume);
    channel_.show(worn);
  }

 private:
  Bone bone_;
  PilotHoleSurface channel_;
  TractOutline outline_;
  Shank shank_;
  TipPath path_;
};

}  // namespace tractus::view
