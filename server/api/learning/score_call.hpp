/// A score to a line item of a learning platform (LTI Assignment and Grade Services 2.0, section 3.4), with an access token by a signed
/// assertion (1EdTech Security Framework 1.0, section 4.1; RFC 7523).
#pragma once

#include <chrono>

#include "db/store/learning/line_items.hpp"
#include "db/store/learning/platforms.hpp"
#include "server/api/learning/tool_key.hpp"
#include "server/http/networks.hpp"

namespace tractus::api {

struct ScoreCall {
  store::Platform platform = {};
  store::LineItemScore what = {};
  ToolKey key = {};
  std::int64_t at_utc_us = 0;
  http::Networks networks = {};                ///< private networks that may be called
  std::chrono::milliseconds patience{10'000};  ///< time limit of each of the two requests
};

/// The score as the platform takes it: right answers of planned trials, Completed once all trials
/// are recorded, FullyGraded once all are scored too.
core::Json score_json(const store::LineItemScore& what, std::int64_t at_utc_us);
/// "https://lms/items/7?type=x" is "https://lms/items/7/scores?type=x".
std::string scores_address(const std::string& line_item);

/// Errors: unavailable (try again), bad_input (refused for good: 400, 404, 409, 410, 422).
core::Result<void> post_score(const ScoreCall& call);

}  // namespace tractus::api
