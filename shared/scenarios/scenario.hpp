/// A probing scenario: the eight numbers that an expert tunes, where the walls are, who tuned it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "laws/probing_law.hpp"
#include "models/probing_model.hpp"

namespace tractus::scenarios {

/// The four of the study [Probing, section 4, Fig. 6].
enum class Kind : unsigned char {
  hard,            ///< dense bone, no breach
  soft,            ///< the same bone, less dense
  lateral_breach,  ///< through the wall into soft tissue, to the probe stop
  in_out_in        ///< through the wall and back into bone
};
inline constexpr int kKinds = 4;
constexpr auto words(Kind) {
  using enum Kind;
  return std::to_array<core::Word<Kind>>({{hard, "hard"},
                                          {soft, "soft"},
                                          {lateral_breach, "lateral_breach"},
                                          {in_out_in, "in_out_in"}});
}
using core::name;

/// Normal probing [Probing, Table 1, left].
struct Bone {
  double stiffness_N_per_m = 8000.0;  ///< K, 0 … 2e5
  double damping_Ns_per_m = 5000.0;   ///< D, above 0 … 1e6
  double equilibrium_m = -0.004;      ///< x0, from a layer's start; 0 or before it
  double interval_m = 0.004;          ///< L, thickness of a layer of the lattice, 0.1 mm … travel
};

/// Breach [Probing, Table 1, right].
struct Breach {
  double resistance_interval_m = 0.006;     ///< R_i, at most the bone before the wall
  double resistance_factor_per_m = 105.0;   ///< R_f, 0 … 1e5
  double breach_interval_m = 0.008;         ///< L_b, above 0
  double breach_damping_Ns_per_m = 1200.0;  ///< D_b, above 0 … 1e6
};

/// A stretch of bone that is denser or less dense than the rest: "the spring and damping
/// coefficient is unique to that layer" [Probing, section 4].
struct DensityRegion {
  double start_m = 0.0;
  double thickness_m = 0.0;
  double density = 1.0;  ///< multiplies K and D of the layers whose middle lies in it, 0.05 … 20
};

/// Where a version comes from. A version's own id is made from its contents, so it is never wrong.
struct Origin {
  std::string who;
  std::string when;    ///< UTC, "2026-03-01T12:00:00.123456Z"
  std::string parent;  ///< id of the version it was made from; empty for the first
};

/// `tractus-scenario/1`. A value.
///
/// The bone is a lattice: every stretch of bone (from the entry or from a breach's end, to the next
/// wall or the probe stop) is split into layers of length L. In each, eq. (2) holds with x0 moved
/// to the layer's start, so that resistance builds up over L and drops at the next layer. Density
/// scales K and D; soft tissue (D_b), the growth R_f and lengths are not bone's to scale.
/// Departs from the source, which gives neither numbers nor units: R_f is per metre; x0 may not lie
/// behind a layer's start, where the bone would draw the probe in.
struct Scenario {
  std::string name;
  Kind kind = Kind::hard;
  Bone bone;
  Breach breach;                      ///< used where there is a wall
  std::vector<double> walls_m;        ///< breach thresholds by depth; none for hard and soft
  double density = 1.0;               ///< 0.05 … 20
  std::vector<DensityRegion> layers;  ///< by depth, without overlap; may be empty
  double travel_m = 0.05;             ///< the probe stop, 5 mm … 0.1 m
  laws::RotaryStage rotary;
  Origin origin;

  /// The first thing wrong with it. Errors: out_of_range led by the field's JSON pointer, as
  /// "/bone/stiffness_N_per_m: -1 is outside 0 … 200000".
  core::Result<void> check() const;
  /// The law's parameters. Errors: those of `check` and of the law.
  core::Result<laws::ProbingParameters> expanded() const;
  /// The bone alone as a model for the lab; walls are not a model's.
  core::Result<models::ProbingModel> model() const;
  /// 64 hexadecimal digits of the contents, origin included.
  std::string id() const;

  static core::Result<Scenario> from_json(const core::Json& json, const std::string& where);
  static core::Result<Scenario> read(const std::filesystem::path& path);
  core::Json to_json() const;
};

/// The tuned scenarios that ship, by kind.
core::Result<Scenario> tuned(Kind kind);

}  // namespace tractus::scenarios
