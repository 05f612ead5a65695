#include "drilling/burr.hpp"

#include <algorithm>

#include "core/try.hpp"

namespace tractus::drilling {

double Burr::rate_at_per_s(double force_N) const noexcept {
  return rate_per_s * std::clamp((force_N - threshold_N) / (full_N - threshold_N), 0.0, 1.0);
}

core::Json Burr::to_json() const {
  return {{"radius_m", radius_m},       {"nose_m", nose_m}, {"rate_per_s", rate_per_s},
          {"threshold_N", threshold_N}, {"full_N", full_N}, {"shank_radius_m", shank_radius_m}};
}

core::Result<Burr> Burr::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  Burr burr;
  burr.radius_m = fields.number("radius_m", 3e-4, 5e-3);
  burr.nose_m = fields.number("nose_m", 0.0, 0.9 * burr.radius_m);
  burr.rate_per_s = fields.number("rate_per_s", 0.01, 1000.0);
  burr.threshold_N = fields.number("threshold_N", 0.0, 100.0);
  burr.full_N = fields.number("full_N", 1e-3, 100.0);
  burr.shank_radius_m = fields.number("shank_radius_m", 3e-4, 5e-3);
  if (burr.full_N <= burr.threshold_N)
    fields.wrong("full_N", "a force above threshold_N is expected");
  TRY(fields.done());
  return burr;
}

}  // namespace tractus::drilling
