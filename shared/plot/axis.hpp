/// One axis of a panel: from values to pixels, and where its ticks stand.
#pragma once

#include <string>
#include <vector>

namespace tractus::plot {

struct Tick {
  double at;
  std::string label;
};

/// A range of values, grown by what is shown on it.
struct Range {
  double low = 1.0, high = -1.0;  ///< empty while low > high
  bool empty() const { return low > high; }
  void take(double value);  ///< values that are not finite are left out
};

/// Linear (steps of 1, 2 or 5 times a power of ten) or by decades.
class Axis {
 public:
  /// @param wanted  about how many ticks.
  /// @param snug    ends at the data (time axes); otherwise at the ticks round it.
  static Axis linear(Range range, int wanted, bool snug);
  /// Whole decades round the range; what is not positive lies at the foot.
  static Axis decades(Range range);

  /// 0 at the low end, 1 at the high end; beyond for values outside.
  double share(double value) const;
  const std::vector<Tick>& ticks() const { return ticks_; }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  double low_ = 0.0, high_ = 1.0;
  bool log_ = false;
  std::vector<Tick> ticks_;
};

}  // namespace tractus::plot
