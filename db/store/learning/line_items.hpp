/// Scores of assignments that go to the gradebooks of learning platforms (LTI Assignment and Grade Services 2.0).
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

/// Where the score of a person in an assignment goes.
struct LineItem {
  std::string platform_id, study_id, account_id;
  std::string subject;    ///< the platform's identifier of the person
  std::string url;        ///< of the line item
  std::string sent = {};  ///< AssignedScore::text that the platform has; empty: none
};
/// Replaces url and subject of an earlier launch.
core::Result<void> set_line_item(Writing& tx, const LineItem& item);

/// How a person did in an assignment: counts of the person's trials.
struct AssignedScore {
  std::uint64_t right = 0;      ///< whose answer agrees with the truth
  std::uint64_t done = 0;       ///< recorded
  std::uint64_t planned = 0;    ///< recorded or still to be done
  std::uint64_t assessing = 0;  ///< recorded, and not scored yet
  bool is_complete() const { return done == planned; }
  bool is_graded() const { return is_complete() && assessing == 0; }
  /// "3 of 5, 4 done, 0 assessing": equal texts are equal scores.
  std::string text() const;
};

struct LineItemScore {
  LineItem item;
  AssignedScore score;
};
/// Line items whose score is released, is not the one that the platform has, and does not wait in
/// the outbox.
core::Result<std::vector<LineItemScore>> changed_line_items(Reading& tx);
/// Queues a delivery (deliveries.hpp) for each of changed_line_items.
core::Result<void> queue_scores(Writing& tx, std::int64_t now_utc_us);
/// Of a delivery; none if the results are held again, or the person or the platform was removed.
core::Result<std::optional<LineItemScore>> line_item_of(Reading& tx,
                                                        const std::string& delivery_id);
/// The platform has this score, or it was given up: only another score is queued from now on.
core::Result<void> settle_line_item(Writing& tx, const LineItemScore& which);

}  // namespace tractus::store
