/// Trying an effect on top of a fitted structure: a linear look at every start, then a fit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lab/least_squares.hpp"

namespace lab {

Structure plus(const Structure& structure, std::string_view effect);
Structure minus(const Structure& structure, std::string_view effect);
bool contains(const Structure& structure, std::string_view effect);

/// Values for a structure: those of `from` where the pointers are the same, starts elsewhere.
std::vector<double> carried(const std::vector<Parameter>& to, const Solution& from);

/// What a linear look tells of an effect.
struct Look {
  struct Start {
    std::vector<double> values;  ///< of the larger structure
    double gain = 0.0;           ///< by which the loss should fall
  };
  std::vector<Start> starts;  ///< best first
  /// Share of the effect's response that the base cannot imitate, at the best start: 0 if the
  /// motion never excites it.
  double own_share = 0.0;
  bool excited = false;  ///< responds at all, and not only as the base does
};

/// `at` needs a jacobian of its own point.
Look look(const Residual& residual, const Solution& at, std::string_view effect);

/// The larger structure fitted from the best of the look's starts. `tries`: so many of them.
Solution extend(const Residual& residual, const Solution& at, const Look& look,
                std::string_view effect, int tries);

}  // namespace lab
