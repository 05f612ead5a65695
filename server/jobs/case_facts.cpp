#include "server/jobs/case_facts.hpp"

#include "core/file.hpp"
#include "db/store/cases.hpp"

namespace jobs {
namespace {
constexpr std::uint64_t kMaxJson_bytes = 16u << 20;
}

core::Result<std::optional<core::Json>> case_json_part(store::Store& store,
                                                       const store::Objects& objects,
                                                       const std::string& case_id,
                                                       const std::string& name) {
  auto part = store.read([&](store::Reading& tx) { return store::case_part(tx, case_id, name); });
  if (!part) return part.error();
  if (!*part) return std::optional<core::Json>();
  auto bytes = core::read_file(objects.path_of((*part)->sha256), kMaxJson_bytes);
  if (!bytes) return bytes.error();
  auto json = core::parse_json(core::text_of(*bytes), "case " + case_id + ": " + name);
  if (!json) return json.error();
  return std::optional(std::move(*json));
}

core::Result<CaseFacts> case_facts(store::Store& store, const store::Objects& objects,
                                   const std::string& case_id) {
  auto manifest = case_json_part(store, objects, case_id, "case.json");
  if (!manifest) return manifest.error();
  if (!*manifest) return core::Error{core::Errc::not_found, "no case " + case_id};
  auto definition = cases::Case::from_json(**manifest, "case " + case_id);
  if (!definition) return definition.error();
  CaseFacts out{std::move(*definition), std::nullopt};
  auto truth = case_json_part(store, objects, case_id, "truth.json");
  if (!truth) return truth.error();
  if (!*truth) return out;
  auto known = cases::Truth::from_json(**truth, "case " + case_id + ": truth.json");
  if (!known) return known.error();
  out.truth = std::move(*known);
  return out;
}

}  // namespace jobs
