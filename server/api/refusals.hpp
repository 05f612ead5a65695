/// Refused requests in the audit trail, limited in rate so that nobody can flood the trail.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "core/json.hpp"
#include "server/http/message.hpp"

namespace tractus::api {

/// Limits the rate of refusals in the audit trail: for one caller a burst of kBurst and then
/// kPerMinute, for all callers together kAllPerMinute. Refusals above the limit are counted, and
/// the next entry states their number. Distinguishes at most kCallers callers. Thread-safe.
class RefusalLimit {
 public:
  static constexpr double kBurst = 10, kPerMinute = 5, kAllPerMinute = 120;
  static constexpr std::size_t kCallers = 1024;

  /// Nothing: do not write this refusal. Else the number of earlier refusals that were not written.
  std::optional<std::uint64_t> turn(const std::string& caller, std::int64_t now_utc_us);

 private:
  struct Bucket {
    double left = kBurst;
    std::int64_t at_utc_us = 0;
  };
  static bool draw(Bucket& bucket, double per_minute, double most, std::int64_t now_utc_us);

  std::mutex mutex_;  ///< guards what follows
  std::map<std::string, Bucket> callers_;
  Bucket all_{kAllPerMinute, 0};
  std::uint64_t unnoted_ = 0;
};

struct Backend;
struct Caller;

/// Whether an answer of this status to a station is a refusal for the audit trail. Routine refusals
/// are not: another upload offset, a full disk, a revoked token.
bool is_refusal_of_station(const std::string& route, int status);
/// The error message of an answer, one line of at most 300 bytes.
std::string words_of(const http::Response& response);

/// Writes a refusal into the audit trail: what = "refused: ROUTE". `object` as in audit_entry.hpp,
/// `why` is the reason, `status` is the status of the answer, 0 if a connection was closed. Never
/// fails: an error when writing the trail is logged.
void note_refusal(Backend& backend, const Caller& caller, const std::string& peer,
                  const std::string& route, const std::string& object, const std::string& why,
                  int status = 0);
/// The same for a person whom another system vouched for and whom no account knows, so that an
/// administrator can link the person. All such refusals share one limit.
void note_stranger(Backend& backend, const std::string& peer, const std::string& route,
                   const core::Json& detail);

}  // namespace tractus::api
