/// The things in the picture, each with the VTK objects it needs. Lengths in metres, as everywhere.
#pragma once

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>

#include <span>
#include <vector>

#include "station/view/view.hpp"

class vtkActor;
class vtkImageData;

namespace view {

/// The bone: volume rendering of opacity and CT value, the half towards the eye cut away.
class Bone {
 public:
  void add(vtkRenderer& renderer, const Scene& scene);
  /// Takes the counts of `box` anew.
  void carve_away(const volume::Box& box, const volume::Volume& volume);

 private:
  vtkSmartPointer<vtkImageData> image_;
};

/// The tract: rings and its axis.
class TractOutline {
 public:
  void add(vtkRenderer& renderer, const volume::Tract& tract);
};

/// The probe: handle, bent shank, contact points.
class Shank {
 public:
  void add(vtkRenderer& renderer, const laws::PalpationParameters& probe);
  void pose(const ProbeState& state);

 private:
  laws::PalpationParameters probe_;
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
  void carve_away(const volume::Box& box, const volume::Volume& volume) {
    bone_.carve_away(box, volume);
  }

 private:
  Bone bone_;
  TractOutline outline_;
  Shank shank_;
  TipPath path_;
};

}  // namespace view
