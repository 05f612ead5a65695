/// What was recorded, as the engine sees it: trials, channels, states.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace tractus::lab {

/// One channel that is compared.
struct Channel {
  std::string name;        ///< "fz_N"; palpation's primary "force_N", the norm of the force's error
  double noise_floor = 0;  ///< rmse that a true model would have: the channel's own noise with the
                           ///< motion's noise as it passes through the base model
  std::size_t components = 0;  ///< if it is a norm: of so many of the channels after it
  double measured_rms = 0.0;   ///< root mean square of what was measured; 0: not told
};

/// Named states of one trial at the full rate ("depth_m", "speed_m_s", …), for finding where an
/// error sits and on what it depends: [state][sample], one sample per Residuals::t_s.
struct States {
  std::vector<std::string> names;
  std::vector<std::vector<double>> values;
};

/// Laws of physics by which a force that no model has may follow from what was recorded, each a sum of terms with numbers
/// that all trials share. The first holds what is no news: what the model, the sensor and the effects of the catalogue do.
struct ForceLaws {
  struct Law {
    std::string name;  ///< "the contact force of before"
    std::vector<Eigen::Matrix3Xd>
        terms;  ///< the force for a number of 1, in the errors' frame, one column per sample
  };
  std::vector<Law> laws;
  std::vector<double> error_sd_N;  ///< per sample, of an error's length where the model is right
};

/// Const methods may be called from several threads at once.
class RecordedTrials {
 public:
  virtual ~RecordedTrials() = default;

  virtual std::string_view rig() const = 0;
  virtual int trials() const = 0;
  virtual std::string trial_id(int trial) const = 0;
  virtual double seconds(int trial) const = 0;
  /// What was compared; the first is the primary.
  virtual const std::vector<Channel>& channels() const = 0;
  virtual States states(int trial) const = 0;
  /// What may predict an error: the states and, where errors are vectors, vectors in the errors' frame.
  virtual States predictors(int trial) const { return states(trial); }
  /// None where errors are no vectors.
  virtual ForceLaws force_laws(int) const { return {}; }
  /// Remarks on the recording itself that belong into every answer: "tz_Nm was not recorded: …".
  virtual const std::vector<std::string>& notes() const = 0;
};

}  // namespace tractus::lab
