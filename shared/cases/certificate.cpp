#include "cases/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus {
namespace cases {
namespace {

constexpr const char* kCertificateFormat = "tractus-certificate/1";

core::Json word_or_null(const auto& value) {
  return value ? core::Json(std::string(name(*value))) : core::Json();
}

}  // namespace

std::optional<double> WallCertificate::d_prime() const {
  if (!at_m) return std::nullopt;
  if (wall == volume::Wall::anterior) return told.k;
  if (!told.b) return std::nullopt;
  return told.k ? std::min(*told.k, *told.b) : *told.b;
}

bool WallCertificate::passes() const {
  const auto d = d_prime();
  if (!d) return false;
  if (wall == volume::Wall::anterior) return *d >= kLeastEnd && end_force_N >= kLeastEndForce_N;
  return *d >= kLeastSide && *told.b >= *told.fa + kLeastOverFalse;
}

core::Json WallCertificate::to_json() const {
  return {{"wall", volume::name(wall)},
          {"passes", passes()},
          {"at_m", core::or_null(at_m)},
          {"k", core::or_null(told.k)},
          {"b", core::or_null(told.b)},
          {"fa", core::or_null(told.fa)},
          {"motion", word_or_null(told.motion)},
          {"contrast", word_or_null(told.contrast)},
          {"lean_m", told.lean_m},
          {"force_N", told.force_N},
          {"end_force_N", wall == volume::Wall::anterior ? core::Json(end_force_N) : core::Json()},
          {"why_not", core::or_null(why_not)}};
}

bool Certificate::passes() const {
  return !walls.empty() && std::ranges::all_of(walls, &WallCertificate::passes);
}

std::string Certificate::warning() const {
  std::string out;
  for (const WallCertificate& wall : walls) {
    if (wall.passes()) continue;
    const auto d = wall.d_prime();
    out += fmt::format("{}{} ({})", out.empty() ? "" : ", ", volume::name(wall.wall),
                       d ? fmt::format("d′ {:.1f}", *d) : "not tried");
  }
  return out.empty() ? out : "breaches of these walls cannot be told by feel: " + out;
}

core::Json Certificate::to_json() const {
  core::Json out = {{"format", kCertificateFormat},
                    {"passes", passes()},
                    {"preparation", volume::name(preparation)},
                    {"perception",
                     {{"force_weber", perception.force_weber},
                      {"force_threshold_N", perception.force_threshold_N},
                      {"wander_m", perception.wander_m}}},
                    {"walls", core::Json::array()},
                    {"sensitivities", core::Json::array()}};
  for (const WallCertificate& wall : walls) out["walls"].push_back(wall.to_json());
  for (const Sensitivity& one : sensitivities) {
    core::Json d_prime;
    for (std::size_t w = 0; w < one.d_prime.size(); ++w)
      d_prime[std::string(volume::name(volume::kWalls[w]))] = core::or_null(one.d_prime[w]);
    out["sensitivities"].push_back(
        {{"assumption", one.assumption}, {"value", one.value}, {"d_prime", d_prime}});
  }
  return out;
}

}  // namespace cases
}  // namespace tractus
