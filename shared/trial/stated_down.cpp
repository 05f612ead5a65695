#include "core/try.hpp"
#include "trial/measurement_set.hpp"

namespace tractus::trial {

core::Result<math::Vec3> stated_down(const PalpationSet& set) {
  const auto it = set.stated.find("down");
  if (it == set.stated.end()) return math::Vec3(-math::Vec3::UnitZ());
  core::Json object;
  object["down"] = *it;
  core::Fields fields(object, "set.json: ");
  const auto numbers = fields.numbers("down", 3);
  TRY(fields.done());
  const math::Vec3 down(numbers[0], numbers[1], numbers[2]);
  if (!(down.norm() > 1e-9))
    return core::Error{core::Errc::bad_input,
                       "set.json: /down: a direction is expected, as [0, 0, -1]"};
  return math::Vec3(down.normalized());
}

}  // namespace tractus::trial
