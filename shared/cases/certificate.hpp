/// The certificate of a case: what an ideal observer can tell of each wall of its tract.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cases/observer.hpp"
#include "core/json.hpp"
#include "volume/fill.hpp"

namespace tractus::cases {

/// A place of a wall at which a breach was tried, and what can be told of it there.
struct TriedPlace {
  double at_m = 0.0;  ///< depth along the tract
  Detectability told = {};
  double foretold = 0.0;  ///< Observer::foretold
};

/// One wall: of the breach that the case has there, else of the one that its maker would make.
struct WallCertificate {
  /// d′ that a side wall must reach with min(K, B), the end with K; so much must B lie over FA.
  static constexpr double kLeastSide = 2.5, kLeastEnd = 2.0, kLeastOverFalse = 0.5;
  static constexpr double kLeastForetold = 0.75;   ///< of the breach
  static constexpr double kLeastEndForce_N = 0.3;  ///< of whole bone, within 3 mm beyond the end

  volume::Wall wall = volume::Wall::medial;
  std::optional<double> at_m = {};  ///< depth along the tract; absent where there is no place
  Detectability told = {};
  double foretold = 0.0;                ///< Observer::foretold
  double end_force_N = 0.0;             ///< of the end alone
  std::string why_not = {};             ///< one line for a wall that was not tried
  std::vector<TriedPlace> places = {};  ///< of a side wall: all that were tried, by depth

  /// min(K, B) of a side wall, K of the end; absent where it was not tried.
  std::optional<double> d_prime() const;
  bool passes() const;
  core::Json to_json() const;
};

/// How d′ changes with one assumption.
struct Sensitivity {
  std::string assumption;  ///< a field of Perception
  double value = 0.0;
  std::array<std::optional<double>, volume::kWalls.size()> d_prime = {};
};

/// `certificate.json`, format `tractus-certificate/1`, a secret part: it shows where the breach is.
struct Certificate {
  volume::Preparation preparation = volume::Preparation::published;
  Perception perception = {};
  double from_m = 0.0;  ///< depth along the tract of the first place that is felt
  std::vector<WallCertificate> walls = {};  ///< in the order of volume::kWalls
  std::vector<Sensitivity> sensitivities = {};

  /// Every wall passes: so the word tells nothing of which is breached.
  bool passes() const;
  /// One line for the person who made the case: the walls that do not pass, with their numbers;
  /// empty when all do.
  std::string warning() const;
  core::Json to_json() const;
};

/// Of a file that `tractus-station threshold` wrote, format `tractus-observer/1`: a person's own
/// thresholds of force in place of the assumed ones; the wander stays assumed. Errors: those of
/// core::read_json; bad_input naming the field.
core::Result<Perception> read_perception(const std::filesystem::path& path);

/// d′ of a wall by a certificate's JSON; absent where it does not say.
std::optional<double> d_prime_of(const core::Json& certificate, volume::Wall wall);

}  // namespace tractus::cases
