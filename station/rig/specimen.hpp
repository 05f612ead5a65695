/// SIMULATED material in front of the probe, for recordings that the rig makes by itself. Written apart from the law that the
/// lab fits: the two share no code.
#pragma once

#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::rig {

/// Layers of springs and dampers, with dry friction all along the inserted shaft.
class Specimen {
 public:
  struct Layer {
    double from_m = 0.0, to_m = 0.0, stiffness_N_per_m = 0.0, damping_Ns_per_m = 0.0,
           equilibrium_m = 0.0;
  };

  Specimen() = default;  ///< nothing there
  /// {"format": "tractus-specimen/1", "layers": [{"from_m", "to_m", "stiffness_N_per_m", "damping_Ns_per_m",
  /// "equilibrium_m"}, …], "friction_N": 0}. Errors: bad_input naming the field.
  static core::Result<Specimen> from_json(const core::Json& json, const std::string& where);

  bool empty() const noexcept { return layers_.empty(); }
  /// Push that moves the probe through it, positive into the bone: K (x − x0) + D v + F tanh(v / v0).
  double push_N(double x_m, double v_m_s) const noexcept;

 private:
  std::vector<Layer> layers_;
  double friction_N_ = 0.0;
};

}  // namespace tractus::rig
