/// Tries an effect on top of a fitted structure: a linear screen from every start, then a fit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

Structure plus(const Structure& structure, std::string_view effect);
Structure minus(const Structure& structure, std::string_view effect);
bool contains(const Structure& structure, std::string_view effect);

/// Values for a structure: those of `from` where the pointers are the same, starts elsewhere.
std::vector<double> carried(const std::vector<Parameter>& to, const Solution& from);

/// What a linear screen says about an effect.
struct LinearScreen {
  /// A number that was moved from where its effect vanishes.
  struct Strength {
    std::size_t parameter = 0;  ///< of the larger structure
    double moved = 0.0;         ///< by how much
    double response =
        0.0;  ///< sum of squares, whitened, of what that adds and the base cannot imitate
  };
  struct Start {
    std::vector<double> values;  ///< of the larger structure
    double gain = 0.0;           ///< by which the loss should fall
    std::vector<Strength> strengths;
  };
  std::vector<Start> starts;  ///< best first
  /// Share of the effect's response that the base cannot imitate, at the best start: 0 if the
  /// motion never excites it.
  double independent_share = 0.0;
  bool excited = false;  ///< responds at all, and not only as the base does
};

/// `at` needs a jacobian of its own point.
LinearScreen linear_screen(const Residual& residual, const Solution& at, std::string_view effect);

/// The larger structure fitted from the best `tries` starts of the screen.
Solution extend(const Residual& residual, const Solution& at, const LinearScreen& linear_screen,
                std::string_view effect, int tries);

}  // namespace tractus::lab
