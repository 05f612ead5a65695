#include "fuzz/target.hpp"
#include "server/http/multipart.hpp"

namespace tractus {
namespace fuzz {
namespace {

struct Seen {
  bool taken = false;
  std::string parts;
};

Seen parts_of(std::string_view body, std::size_t piece) {
  Seen out;
  const auto note = [&out](std::string_view text) -> core::Result<void> {
    out.parts += text;
    return {};
  };
  http::Multipart parts("b", "somebody",
                        {.begin = [&](const std::string& type) { return note("[" + type + "|"); },
                         .bytes = note,
                         .end = [&] { return note("]"); }});
  for (std::size_t at = 0; at < body.size(); at += piece)
    if (!taken(parts.take(body.substr(at, piece)))) return out;
  out.taken = taken(parts.finish());
  return out;
}

bool run(core::ByteView bytes) {
  const auto text = core::text_of(bytes);
  const auto media = http::media_type_of(text);
  core::require(media.type.size() + media.boundary.size() <= text.size(), "both are of the header");
  const Seen whole = parts_of(text, std::max<std::size_t>(1, text.size()));
  const Seen split = parts_of(text, 1);
  core::require(whole.taken == split.taken, "pieces make no difference");
  core::require(!whole.taken || whole.parts == split.parts, "pieces make no difference to parts");
  return whole.taken;
}

}  // namespace

Target multipart_body() { return {"multipart_body", "files of a series, from a PACS", {}, run}; }

}  // namespace fuzz
}  // namespace tractus
