#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "fmu/module/simulation.hpp"
#include "models/palpation_stream.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using effects::HandleMotion;
using math::Vec3;

constexpr double kOffUnitLength = 0.01;  // of a quaternion, as recordings are read

Vec3 vector_at(std::span<const double> values, PalpationPlace place) {
  const auto k = std::size_t(place);
  return Vec3(values[k], values[k + 1], values[k + 2]);
}

Result<HandleMotion> handle_of(std::span<const double> values, const Vec3& down) {
  const auto k = std::size_t(PalpationPlace::q);
  math::Quat q(values[k], values[k + 1], values[k + 2], values[k + 3]);
  if (!(std::abs(q.norm() - 1.0) <= kOffUnitLength))
    return Error{
        Errc::out_of_range,
        fmt::format("qw to qz: the quaternion's length is {:.4g}, 1 is expected", q.norm())};
  // One that has unit length to rounding stays as it is, so that forces are those of a replay to the last bit.
  if (std::abs(q.squaredNorm() - 1.0) > 1e-14) q.normalize();
  return HandleMotion{
      {vector_at(values, PalpationPlace::p_m), q},     vector_at(values, PalpationPlace::v_m_s),
      vector_at(values, PalpationPlace::omega_rad_s),  vector_at(values, PalpationPlace::a_m_s2),
      vector_at(values, PalpationPlace::alpha_rad_s2), down};
}

class PalpationSimulation final : public Simulation {
 public:
  PalpationSimulation(models::PalpationRuntime runtime, const volume::Box& box, const Vec3& down)
      : runtime_(std::make_shared<const models::PalpationRuntime>(std::move(runtime))),
        box_(box),
        down_(down),
        stream_(*runtime_) {}

  std::unique_ptr<Simulation> copy() const override {
    return std::make_unique<PalpationSimulation>(*this);
  }
  Result<std::vector<double>> outputs(double t_s, std::span<const double> values) override {
    TRY(look_ahead(t_s, values));
    const laws::PalpationStep& s = ahead_->step;
    const auto& [F, T] = s.wrench_H;
    return std::vector{F.x(),
                       F.y(),
                       F.z(),
                       T.x(),
                       T.y(),
                       T.z(),
                       s.deflection_m.x(),
                       s.deflection_m.y(),
                       double(s.converged)};
  }
  Result<void> keep(double t_s, std::span<const double> values) override {
    TRY(look_ahead(t_s, values));
    stream_ = std::move(ahead_->stream);
    ahead_.reset();
    return {};
  }

 private:
  /// What comes of a moment that the motion has not passed yet: who reads the outputs and then steps pays
  /// for one step.
  struct Ahead {
    double t_s;
    std::vector<double> values;
    models::PalpationStream stream;
    laws::PalpationStep step;
  };
  Result<void> look_ahead(double t_s, std::span<const double> values) {
    if (ahead_ && ahead_->t_s == t_s && std::ranges::equal(ahead_->values, values)) return {};
    const auto handle = TRY(handle_of(values, down_));
    auto stream = stream_;
    runtime_->field().left_part();  // of another simulation on the same field
    const auto step = stream.keep(t_s, handle);
    if (runtime_->field().left_part())
      return outside(t_s, runtime_->tip_m(handle.X_VH, step.deflection_m));
    if (!step.wrench_H.force_N.allFinite() || !step.wrench_H.torque_Nm.allFinite())
      return Error{
          Errc::out_of_range,
          fmt::format("the force at {} s is no number: the motion is beyond all measure", t_s)};
    ahead_ = Ahead{t_s, {values.begin(), values.end()}, std::move(stream), step};
    return {};
  }
  Error outside(double t_s, const Vec3& tip_m) const {
    const Vec3 at = runtime_->field().geometry().index_of(tip_m);
    return {Errc::out_of_range,
            fmt::format(
                "at {} s the probe leaves the part of the volume that this FMU carries: the "
                "tip is at ({:.5f}, {:.5f}, {:.5f}) m, voxel ({:.1f}, {:.1f}, {:.1f}); "
                "carried are voxels ({}, {}, {}) to ({}, {}, {}), of which three at each "
                "side are margin. Export with a larger --margin or --box",
                t_s, tip_m.x(), tip_m.y(), tip_m.z(), at.x(), at.y(), at.z(), box_.begin[0],
                box_.begin[1], box_.begin[2], box_.end[0] - 1, box_.end[1] - 1, box_.end[2] - 1)};
  }

  std::shared_ptr<const models::PalpationRuntime> runtime_;
  volume::Box box_;
  Vec3 down_;
  models::PalpationStream stream_;
  std::optional<Ahead> ahead_;
};

class CarriedPalpation final : public Carried {
 public:
  CarriedPalpation(models::PalpationModel model, volume::ForceField field, const volume::Box& box,
                   const Vec3& down)
      : Carried(fmu::variables(model, down)),
        model_(std::move(model)),
        field_(std::move(field)),
        box_(box) {}

  double longest_step_s() const noexcept override { return models::kLongestGap_s; }
  Result<std::unique_ptr<Simulation>> simulation(std::span<const double> values, double,
                                                 std::optional<double>) const override {
    const auto numbers = TRY(with_parameters(model_, variables(), values));
    auto runtime = TRY(models::PalpationRuntime::make(numbers.model, field_));
    return std::unique_ptr<Simulation>(
        new PalpationSimulation(std::move(runtime), box_, numbers.down));
  }

 private:
  models::PalpationModel model_;
  volume::ForceField field_;
  volume::Box box_;
};

}  // namespace

Result<std::unique_ptr<Carried>> carried(models::PalpationModel model, const CarriedField& field) {
  auto made = TRY(volume::ForceField::make(field.part, model.field));
  return std::unique_ptr<Carried>(
      new CarriedPalpation(std::move(model), std::move(made), field.part.box, field.down));
}

}  // namespace fmu
}  // namespace tractus
