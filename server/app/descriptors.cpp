#include "server/app/descriptors.hpp"

#include <sys/resource.h>

#include <algorithm>

#include "server/app/log.hpp"

namespace tractus::app {

int connections_within_limit(int wanted) {
  constexpr rlim_t kOther = 256;  // pieces being written, files being sent, database, pipes
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return wanted;
  limit.rlim_cur = limit.rlim_max;
  if (::setrlimit(RLIMIT_NOFILE, &limit) != 0) ::getrlimit(RLIMIT_NOFILE, &limit);
  const rlim_t room = limit.rlim_cur > 2 * kOther ? limit.rlim_cur - kOther : limit.rlim_cur / 2;
  if (room >= static_cast<rlim_t>(wanted)) return wanted;
  log_line({{"what", "too few file descriptors for all connections: raise the hard limit"},
            {"descriptors", limit.rlim_cur},
            {"connections", room}});
  return static_cast<int>(room);
}

}  // namespace tractus::app
