/// A tool that changes the bone while it is felt, as the loop sees it.
#pragma once

#include <cstdint>

#include "trial/trial.hpp"

namespace tractus::loop {

/// Both calls come from the loop's thread alone and are under the tick's rules.
class Tool {
 public:
  virtual ~Tool() = default;
  /// Before the model is asked: what is finished becomes the bone that this tick feels. Returns how
  /// many changes have so far (trial::Sample::patches).
  /// @param t_s  stamp of the tick since the loop's start
  virtual std::uint32_t apply(double t_s) noexcept = 0;
  /// After the tick, with what is recorded of it.
  virtual void worked(const trial::Sample& sample) noexcept = 0;
};

}  // namespace tractus::loop
