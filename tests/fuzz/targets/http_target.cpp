#include "fuzz/target.hpp"
#include "server/http/message.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto text = core::text_of(bytes);
  http::RequestHead head;
  const bool target = taken(http::read_target(text, head));
  taken(http::percent_decoded(text));
  head.headers["x-forwarded-for"] = text;
  head.headers["cookie"] = text;
  http::forwarded_peer(head);
  core::require(head.cookie("tractus_session").size() <= text.size(), "a cookie is of the header");
  if (const auto range = http::byte_range(text, 1000); taken(range) && *range)
    core::require((*range)->first <= (*range)->second && (*range)->second < 1000,
                  "a range lies in the file");
  return target;
}
}  // namespace

Target http_target() {
  return {"http_target", "target and headers of a request, from anybody", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
