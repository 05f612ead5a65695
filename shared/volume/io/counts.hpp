/// From whatever numbers a file holds to our 16-bit counts.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/result.hpp"
#include "core/try.hpp"

namespace tractus::volume_io {

/// CT value = intercept + slope · count.
struct Counts {
  std::vector<std::uint16_t> counts;
  double slope = 1.0;
  double intercept = 0.0;
  std::string note;  ///< empty when every value is kept exactly
};

/// What `span_to_counts` needs to know before it converts.
struct Span {
  double low = 0.0, high = 0.0;
  bool whole = true;  ///< all values are whole numbers
};

/// Least and greatest value. Errors: bad_input with the index of the first value that is not a
/// finite number.
template <class T>
core::Result<Span> span_of(std::span<const T> raw) {
  Span out{static_cast<double>(raw[0]), static_cast<double>(raw[0]), true};
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const auto value = static_cast<double>(raw[i]);
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(value))
        return core::Error{
            core::Errc::bad_input,
            fmt::format("voxel {} of {} is {}, a finite number is expected", i, raw.size(), value)};
      out.whole = out.whole && value == std::trunc(value);
    }
    out.low = std::min(out.low, value);
    out.high = std::max(out.high, value);
  }
  return out;
}

/// Converts file values v with CT value = offset + scale · v (scale ≠ 0). Exact for whole numbers
/// over a range of at most 65535; else 65536 equal levels, and the note says how wide one is. A
/// negative scale counts downward. Errors: bad_input (a value that is no finite number, or a range
/// that overflows).
template <class T>
core::Result<Counts> counts_of(std::span<const T> raw, double scale, double offset) {
  const auto span = TRY(span_of(raw));
  const double range = span.high - span.low;
  const bool exact = span.whole && range <= 65535.0;
  const double step = exact ? 1.0 : range / 65535.0;
  const double from = scale > 0 ? span.low : span.high;
  const double sign = scale > 0 ? 1.0 : -1.0;
  Counts out{
      std::vector<std::uint16_t>(raw.size()), step * std::abs(scale), offset + scale * from, {}};
  if (!std::isfinite(out.intercept) || !(out.slope > 0.0 && out.slope < 1e9))
    return core::Error{core::Errc::bad_input,
                       fmt::format("values from {} to {} are none a CT has", span.low, span.high)};
  for (std::size_t i = 0; i < raw.size(); ++i)
    out.counts[i] = static_cast<std::uint16_t>(std::clamp(
        std::nearbyint(sign * (static_cast<double>(raw[i]) - from) / step), 0.0, 65535.0));
  if (!exact)
    out.note =
        fmt::format("values were rounded to 65536 levels of {:.6g} between {:.6g} and {:.6g}",
                    out.slope, offset + scale * span.low, offset + scale * span.high);
  return out;
}

}  // namespace tractus::volume_io
