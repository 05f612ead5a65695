#include "cases/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

constexpr const char* kCertificateFormat = "tractus-certificate/1";
constexpr const char* kObserverFormat = "tractus-observer/1";

core::Json word_or_null(const auto& value) {
  return value ? core::Json(std::string(name(*value))) : core::Json();
}

/// To a hundredth: a list of places stays short.
core::Json hundredth_or_null(const std::optional<double>& value) {
  return value ? core::Json(std::round(*value * 100.0) / 100.0) : core::Json();
}

core::Json places_json(const std::vector<TriedPlace>& places) {
  core::Json at = core::Json::array(), k = at, b = at, fa = at;
  for (const TriedPlace& place : places) {
    at.push_back(std::round(place.at_m * 1e5) / 1e5);
    k.push_back(hundredth_or_null(place.told.k));
    b.push_back(hundredth_or_null(place.told.b));
    fa.push_back(hundredth_or_null(place.told.fa));
  }
  return {{"at_m", at}, {"k", k}, {"b", b}, {"fa", fa}};
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
  if (!d || foretold < kLeastForetold) return false;
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
          {"fa_wall", word_or_null(told.fa_wall)},
          {"fa_at_m", told.fa_wall ? core::Json(told.fa_at_m) : core::Json()},
          {"motion", word_or_null(told.motion)},
          {"contrast", word_or_null(told.contrast)},
          {"lean_m", told.lean_m},
          {"force_N", told.force_N},
          {"foretold", std::round(foretold * 1000.0) / 1000.0},
          {"end_force_N", wall == volume::Wall::anterior ? core::Json(end_force_N) : core::Json()},
          {"why_not", core::or_null(why_not)},
          {"places", places_json(places)}};
}

bool Certificate::passes() const {
  return !walls.empty() && std::ranges::all_of(walls, &WallCertificate::passes);
}

std::string Certificate::warning() const {
  std::string out;
  for (const WallCertificate& wall : walls) {
    if (wall.passes()) continue;
    const auto d = wall.d_prime();
    out += fmt::format(
        "{}{} ({})", out.empty() ? "" : ", ", volume::name(wall.wall),
        d ? fmt::format("d′ {:.1f}, {:.0f} % right", *d, 100.0 * wall.foretold) : "not tried");
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

core::Result<Perception> read_perception(const std::filesystem::path& path) {
  const core::Json file = TRY(core::read_json(path));
  const auto refuse = [&](const std::string& why) {
    return core::Error{core::Errc::bad_input, fmt::format("{}: {}", path.string(), why)};
  };
  if (core::text_member(file, "format") != kObserverFormat)
    return refuse(
        fmt::format("no file of format {}: tractus-station threshold makes one", kObserverFormat));
  Perception out;
  const auto perception = file.value("perception", core::Json::object());
  for (const auto& [key, field, least, most] :
       {std::tuple{"force_threshold_N", &Perception::force_threshold_N, 0.001, 1.0},
        std::tuple{"force_weber", &Perception::force_weber, 0.0, 2.0}}) {
    const auto at = perception.find(key);
    if (at == perception.end() || !at->is_number() || !(at->get<double>() >= least) ||
        !(at->get<double>() <= most))
      return refuse(
          fmt::format("perception: {}: a number from {} to {} is expected", key, least, most));
    out.*field = at->get<double>();
  }
  return out;
}

std::optional<double> d_prime_of(const core::Json& certificate, volume::Wall wall) {
  std::optional<double> out;
  const auto walls = certificate.find("walls");
  if (walls == certificate.end() || !walls->is_array()) return out;
  for (const core::Json& one : *walls) {
    if (core::text_member(one, "wall") != volume::name(wall)) continue;
    for (const char* key : {"k", "b"})
      if (const auto at = one.find(key); at != one.end() && at->is_number())
        out = std::min(out.value_or(at->get<double>()), at->get<double>());
  }
  return out;
}

}  // namespace cases
}  // namespace tractus
