/// What stations were refused, in the audit trail, without letting them flood it.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "server/http/message.hpp"

namespace api {

struct Backend;

class Refusals {
 public:
  struct Refusal {
    std::string station, peer;
    std::string route;  ///< its id; "nothing" for an address that is none
    int status = 0;     ///< 0: hung up on
    std::string why;
  };
  /// Is an answer of this status a refusal that somebody should see? Not those of every day: an
  /// upload that stands elsewhere, a disk that is full, a token that is not known any more.
  static bool is_one(const std::string& route, int status);
  /// The one line that the answer gives as its reason.
  static std::string words_of(const http::Response& response);

  /// Notes it, at most kBurst at once and then one each kEvery_us for each station; what was left
  /// out is counted in the next that is noted. A trail that cannot be written is said in the log.
  void note(Backend& backend, const Refusal& refusal);

  static constexpr std::int64_t kBurst = 20, kEvery_us = 30'000'000;

 private:
  struct Account {
    std::int64_t full_utc_us = 0;  ///< when its allowance is whole again
    std::uint64_t left_out = 0;
  };
  std::mutex mutex_;  ///< guards accounts_
  std::map<std::string, Account> accounts_;
};

}  // namespace api
