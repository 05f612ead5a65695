#include "server/app/log.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "core/clock.hpp"

namespace tractus::app {

void log_line(const core::Json& fields) {
  core::Json line{{"t", core::utc_text(core::utc_us())}};
  line.update(fields);
  fmt::print(stderr, "{}\n", line.dump(-1, ' ', false, core::Json::error_handler_t::replace));
}

}  // namespace tractus::app
