#include "wire/messages.hpp"

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus::wire {
namespace {
constexpr long kMaxTrial_bytes = 8l << 30;
}

core::Json UploadState::to_json() const {
  return {{"offset_bytes", offset_bytes}, {"state", core::name(state)}};
}

core::Result<UploadState> UploadState::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  UploadState out;
  out.offset_bytes = static_cast<std::uint64_t>(fields.integer("offset_bytes", 0, kMaxTrial_bytes));
  out.state = fields.word<trial::UploadPhase>("state");
  TRY(fields.done());
  return out;
}

core::Json UploadAnnouncement::to_json() const {
  return {{"case_id", case_id}, {"size_bytes", size_bytes}, {"sha256", sha256}};
}

core::Result<UploadAnnouncement> UploadAnnouncement::from_json(const core::Json& json,
                                                               const std::string& where) {
  core::Fields fields(json, where);
  UploadAnnouncement out;
  out.case_id = fields.text("case_id", 64);
  out.size_bytes = static_cast<std::uint64_t>(fields.integer("size_bytes", 1, kMaxTrial_bytes));
  out.sha256 = fields.text("sha256", 64);
  if (!core::is_sha256(out.case_id))
    fields.wrong("case_id", "64 hexadecimal characters are expected");
  if (!core::is_sha256(out.sha256))
    fields.wrong("sha256", "64 hexadecimal characters are expected");
  TRY(fields.done());
  return out;
}

}  // namespace tractus::wire
