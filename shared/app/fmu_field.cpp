#include "app/fmu_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/progress.hpp"
#include "core/try.hpp"
#include "lab/io/unpacked.hpp"
#include "models/palpation_stream.hpp"
#include "trial/measurement_set.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace commands {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;
using math::Vec3;

/// What a sample reads on either side of its voxel (volume/field_sampling.cpp).
constexpr int kBefore = 2, kAfter = 3;

/// Recordings as motions, in the order of the set.
struct Motions {
  std::optional<lab_io::Unpacked> unpacked;
  fs::path volume;  ///< that the set names, or empty
  Vec3 down = -Vec3::UnitZ();
  std::vector<std::string> files;
  std::vector<models::PalpationMotion> of;
};

Result<Motions> read_motions(const fs::path& measurements) {
  Motions out;
  if (measurements.empty()) return out;
  out.unpacked.emplace(TRY(lab_io::Unpacked::open(measurements)));
  const auto set = TRY(trial::read_palpation_set(out.unpacked->folder()));
  const auto down = trial::stated_down(set);
  if (!down) return Error{down.error().code, (measurements / down.error().what).string()};
  out.down = *down;
  if (!set.volume.empty()) out.volume = set.folder / set.volume;
  for (const auto& trial : set.trials) {
    auto motion = models::PalpationMotion::through(trial.t_s, trial.X_VH, out.down);
    if (!motion)
      return Error{motion.error().code, fmt::format("{}: {}", trial.file, motion.error().what)};
    out.files.push_back(trial.file);
    out.of.push_back(std::move(*motion));
  }
  return out;
}

/// The voxels that points were in, as continuous indices.
struct Reach {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = Vec3::Constant(-HUGE_VAL);
  void add(const Vec3& index) {
    low = low.cwiseMin(index);
    high = high.cwiseMax(index);
  }
};

/// What the contact points of all recordings reach, at the samples.
Reach reached_by(const models::PalpationRuntime& runtime, const Motions& motions) {
  Reach out;
  const auto& geometry = runtime.field().geometry();
  const auto& law = runtime.law();
  for (const auto& motion : motions.of) {
    models::PalpationWalk walk(runtime);
    for (const double t_s : motion.t_s) {
      const auto step = walk.to(t_s, motion);
      math::Pose pose = models::between_samples(motion, t_s - runtime.delay_s()).X_VH;
      pose.p += law.parameters().pose_offset_m;
      for (int i = 0; i < law.parameters().points; ++i)
        for (const math::Vec2& bent : {step.deflection_m, math::Vec2(math::Vec2::Zero())})
          out.add(geometry.index_of(pose * law.point_H_m(i, bent)));
    }
  }
  return out;
}

Reach reach_of_box(const volume::Geometry& geometry, const Vec3& a, const Vec3& b) {
  Reach out;
  for (int corner = 0; corner < 8; ++corner)
    out.add(geometry.index_of(
        Vec3(corner & 1 ? a.x() : b.x(), corner & 2 ? a.y() : b.y(), corner & 4 ? a.z() : b.z())));
  return out;
}

/// The voxels that samples in that reach read, the volume's edge repeated outwards.
Result<volume::Box> box_about(const volume::Geometry& geometry, const Reach& reach,
                              double margin_m) {
  volume::Box out;
  std::size_t voxels = 1;
  bool outside = false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = std::size_t(axis);
    const double margin = margin_m / geometry.spacing_m[axis], last = geometry.dims[a] - 1.0;
    const double low = std::floor(reach.low[axis] - margin) - kBefore;
    const double high = std::floor(reach.high[axis] + margin) + kAfter;
    outside = outside || !(high >= 0.0 && low <= last);
    out.begin[a] = int(std::clamp(low, 0.0, last));
    out.end[a] = int(std::clamp(high, 0.0, last)) + 1;
    voxels *= std::size_t(out.end[a] - out.begin[a]);
  }
  if (outside)
    return Error{
        Errc::bad_input,
        fmt::format("the part to carry lies outside the volume, at voxels ({:.0f}, {:.0f}, "
                    "{:.0f}) to ({:.0f}, {:.0f}, {:.0f}); are both in the same frame?",
                    reach.low.x(), reach.low.y(), reach.low.z(), reach.high.x(), reach.high.y(),
                    reach.high.z())};
  if (voxels > fmu::kMostCarriedVoxels)
    return Error{
        Errc::too_large,
        fmt::format("the part to carry has {} × {} × {} voxels, {} MiB; at most {} MiB are "
                    "carried: give a smaller --box",
                    out.end[0] - out.begin[0], out.end[1] - out.begin[1], out.end[2] - out.begin[2],
                    (voxels * sizeof(float)) >> 20,
                    (fmu::kMostCarriedVoxels * sizeof(float)) >> 20)};
  return out;
}

/// Replays on the part alone.
Result<void> check(const models::PalpationModel& model, const fmu::CarriedField& field,
                   const Motions& motions) {
  const auto part = TRY(volume::ForceField::make(field.part, model.field));
  const auto runtime = TRY(models::PalpationRuntime::make(model, part));
  for (std::size_t k = 0; k < motions.of.size(); ++k) {
    models::PalpationWalk walk(runtime);
    for (const double t_s : motions.of[k].t_s) {
      walk.to(t_s, motions.of[k]);
      if (part.left_part())
        return Error{
            Errc::out_of_range,
            fmt::format("{}: at {} s the probe leaves the part of the volume that would be "
                        "carried; give a larger --margin",
                        motions.files[k], t_s)};
    }
  }
  return {};
}

}  // namespace

Result<fmu::CarriedField> carried_field(const models::PalpationModel& model,
                                        const fs::path& model_path, const FieldOptions& options) {
  if (options.measurements.empty() && options.box_m.empty())
    return Error{Errc::bad_input,
                 "a model of the palpation rig takes a part of its volume along: give "
                 "--measurements (what these recordings reach) or --box"};
  const auto motions = TRY(read_motions(options.measurements));
  const fs::path path =
      model.volume.empty() ? motions.volume : model_path.parent_path() / model.volume;
  if (path.empty())
    return Error{Errc::bad_input, "names no \"volume\", and neither do measurements"};
  auto imported = TRY(volume_io::read_volume(path, core::terminal_progress("reading the volume")));
  const auto runtime = TRY(models::PalpationRuntime::make(
      model, imported.volume, core::terminal_progress("making the field")));
  const volume::Geometry& geometry = runtime.field().geometry();
  const auto box =
      options.box_m.empty()
          ? TRY(box_about(geometry, reached_by(runtime, motions), options.margin_m))
          : TRY(box_about(geometry, reach_of_box(geometry, options.box_m[0], options.box_m[1]),
                          0.0));
  fmu::CarriedField out{runtime.field().stored(box), motions.down};
  if (options.box_m.empty()) TRY(check(model, out, motions));
  return out;
}

}  // namespace commands
}  // namespace tractus
