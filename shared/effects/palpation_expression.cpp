#include "effects/palpation_expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace effects {
namespace {

constexpr double kRounded_m_s = 1e-4;  // as of contact_friction: a hand at rest feels no chatter
constexpr double kStep = 1e-5;         // of a difference quotient

/// F = −f v/√(|v|² + v_ε²). How f changes with the point's place is taken through opacity and
/// elastic force, by difference quotients; that the wall's normal turns is left out, so that the
/// shank's equilibrium may take a step more.
class ExpressionAgainstMotion final : public PointForce {
 public:
  ExpressionAgainstMotion(FormulaProgram program, std::span<const double> values)
      : program_(std::move(program)) {
    std::ranges::copy(values, program_.inputs().last(values.size()).begin());
  }

  void add(const PointContact& point, const laws::ForceSample& elastic,
           laws::ForceSample& total) const noexcept override {
    const double elastic_N = elastic.force_N.norm(), speed = point.v_m_s.norm();
    const Vec3 n = elastic_N > 1e-12 ? Vec3(elastic.force_N / elastic_N) : Vec3(Vec3::Zero());
    const double leaving = point.v_m_s.dot(n);
    const Vec3 back = -point.v_m_s / std::hypot(speed, kRounded_m_s);
    const auto in = program_.inputs();
    in[kSpeed] = speed;
    in[kLeaving] = leaving;
    in[kAcross] = (point.v_m_s - leaving * n).norm();
    in[kElastic] = elastic_N;
    in[kOpacity] = point.field->opacity(point.p_m);
    const double f_N = program_.value();
    total.force_N += f_N * back;
    const Vec3 slope = change(kOpacity, f_N) * -point.field->gradient_per_m(point.p_m) +
                       change(kElastic, f_N) * (elastic.jacobian_N_per_m.transpose() * n);
    total.jacobian_N_per_m += back * slope.transpose();
  }

 private:
  enum Input : std::size_t { kSpeed, kLeaving, kAcross, kElastic, kOpacity };
  double change(Input which, double f_N) const noexcept {
    const auto in = program_.inputs();
    const double kept = in[which];
    in[which] = kept + kStep;
    const double out = (program_.value() - f_N) / kStep;
    in[which] = kept;
    return out;
  }
  FormulaProgram program_;
};

}  // namespace

const ExpressionRig& palpation_expressions() {
  static constexpr std::array<ExpressionState, 5> kStates{
      {{"v_m_s", "m/s", "speed of the contact point, of the unbent shank"},
       {"v_n_m_s", "m/s", "of it, along the wall's push: above 0 while leaving"},
       {"v_t_m_s", "m/s", "of it, across the wall's push"},
       {"base_N", "N", "size of the point's elastic force"},
       {"opacity", "1", "blurred opacity of the bone at the point"}}};
  static constexpr ExpressionRig kRig{
      "palpation",
      "f_N",
      "N",
      kStates,
      "presses into one wall and slides along it, each at three speeds",
      false};
  return kRig;
}

core::Result<PalpationEffect> make_palpation_expression(const EffectInstance& use) {
  auto expression = TRY(Expression::of(use, palpation_expressions()));
  TRY(check(expression.facts(), use.values));
  auto program = TRY(expression.program());
  return PalpationEffect(std::unique_ptr<PointForce>(
      std::make_unique<ExpressionAgainstMotion>(std::move(program), use.values)));
}

}  // namespace effects
}  // namespace tractus
