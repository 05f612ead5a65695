/// The collector of traces as the tracer sees it: one POST, one outcome.
#pragma once

#include <functional>
#include <string>

#include "tracing/settings.hpp"

namespace tractus::tracing {

enum class Delivery {
  taken,
  refused,  ///< it does not help to send the same again
  away,     ///< no answer, or an answer that asks for patience
};

struct Delivered {
  Delivery delivery = Delivery::away;
  std::string why = {};        ///< one line, unless it was taken
  std::uint64_t rejected = 0;  ///< spans that the collector did not take of those it took
};

/// Sends a body, within `most`; ends early once `ends` is true.
using Post = std::function<Delivered(const std::string& body, std::chrono::milliseconds most,
                                     const std::function<bool()>& ends)>;

/// By libcurl: no redirects, http and https alone, at most 64 KiB of an answer are read.
Post http_post(const Settings& settings);

}  // namespace tractus::tracing
