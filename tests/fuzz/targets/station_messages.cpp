#include "fuzz/target.hpp"
#include "study/sealed_law.hpp"
#include "wire/assigned_work.hpp"
#include "wire/messages.hpp"
#include "wire/study_work.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  static const study::StationKey key(std::string(64, 'a'));
  taken(study::opened_law(core::text_of(bytes), std::string(64, 'b'), key));
  const auto json = core::parse_json(core::text_of(bytes), "it");
  if (!taken(json)) return false;
  bool any = taken(wire::UploadState::from_json(*json, "it"));
  any |= taken(wire::UploadAnnouncement::from_json(*json, "it"));
  any |= taken(wire::StudyWork::from_json(*json, "it"));
  any |= taken(wire::AssignedWork::from_json(*json, "it"));
  return any;
}
}  // namespace

Target station_messages() {
  return {"station_messages", "what server and station tell one another, sealed laws", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
