/// Refusals in the audit trail: who asked for what is not theirs. Few enough that nobody can flood
/// it.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/http/message.hpp"

namespace tractus::api {

/// Of one caller kBurst refusals are noted at once and kPerMinute from then on, of all callers
/// together kAllPerMinute; what is not noted is counted, and the next that is says how many.
/// Memory: at most kCallers callers are told apart. Safe from several threads.
class RefusalLimit {
 public:
  static constexpr double kBurst = 10, kPerMinute = 5, kAllPerMinute = 120;
  static constexpr std::size_t kCallers = 1024;

  /// Nothing: do not note this one. Else how many before it were not noted.
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

/// Is an answer of this status to a station a refusal that somebody should see? Not those of every
/// day: an upload that stands elsewhere, a disk that is full, a token that is not known any more.
bool is_refusal_of_station(const std::string& route, int status);
/// The one line that an answer gives as its reason, at most 300 bytes.
std::string words_of(const http::Response& response);

/// Notes a refusal: what = "refused: ROUTE". `object` as acts.hpp names it, `why` in our words,
/// `status` of the answer, 0 where a line was hung up.
/// Never fails: a trail that cannot be written is the log's to say.
void note_refusal(Backend& backend, const Caller& caller, const std::string& peer,
                  const std::string& route, const std::string& object, const std::string& why,
                  int status = 0);

}  // namespace tractus::api
