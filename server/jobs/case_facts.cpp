#include "server/jobs/case_facts.hpp"

#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/trials/trials.hpp"

namespace tractus {
namespace jobs {
namespace {
constexpr std::uint64_t kMaxJson_bytes = 16u << 20;

/// Where a channel left the bone, by its trial's own word: the wall it went farthest beyond.
/// @param beyond_m  {wall: m|null}, negative within (shared/drilling/channel.hpp)
std::optional<cases::Truth> truth_of_channel(const core::Json& beyond_m) {
  cases::Truth out;
  bool known = false;
  for (const volume::Wall wall : volume::kWalls) {
    const auto found = beyond_m.find(std::string(volume::name(wall)));
    if (found == beyond_m.end() || !found->is_number()) continue;
    known = true;
    if (found->get<double>() <= out.breach_depth_m) continue;
    out.breach_depth_m = found->get<double>();
    out.breached = wall;
  }
  return known ? std::optional(out) : std::nullopt;
}

/// Nothing where the trial is not here, is of another case, or measured no channel.
std::optional<cases::Truth> truth_of_drilling(const std::optional<store::TrialRecord>& trial,
                                              const std::string& case_id) {
  if (!trial || trial->summary.case_id != case_id) return std::nullopt;
  const core::Json events = core::stored_json(trial->events);
  for (const core::Json& event : events) {
    if (event.value("kind", "") != "drilled" || !event.at("detail").is_object()) continue;
    const core::Json& detail = event.at("detail");
    const auto channel = detail.find("channel");
    if (channel == detail.end() || !channel->is_object()) continue;
    const auto beyond = channel->find("beyond_m");
    if (beyond != channel->end() && beyond->is_object()) return truth_of_channel(*beyond);
  }
  return std::nullopt;
}
}  // namespace

core::Result<std::optional<core::Json>> case_json_part(store::Store& store,
                                                       const store::Objects& objects,
                                                       const std::string& case_id,
                                                       const std::string& name) {
  auto part =
      TRY(store.read([&](store::Reading& tx) { return store::case_part(tx, case_id, name); }));
  if (!part) return std::optional<core::Json>();
  auto bytes = TRY(core::read_file(TRY(objects.file(part->sha256)), kMaxJson_bytes));
  auto json = TRY(core::parse_json(core::text_of(bytes), "case " + case_id + ": " + name));
  return std::optional(std::move(json));
}

core::Result<CaseFacts> case_facts(store::Store& store, const store::Objects& objects,
                                   const std::string& case_id) {
  auto manifest = TRY(case_json_part(store, objects, case_id, "case.json"));
  if (!manifest) return core::Error{core::Errc::not_found, "no case " + case_id};
  auto definition = TRY(cases::Case::from_json(*manifest, "case " + case_id));
  CaseFacts out{std::move(definition), std::nullopt};
  auto truth = TRY(case_json_part(store, objects, case_id, "truth.json"));
  if (!truth) return out;
  auto known = TRY(cases::Truth::from_json(*truth, "case " + case_id + ": truth.json"));
  out.truth = std::move(known);
  const auto certificate = TRY(case_json_part(store, objects, case_id, cases::kCertificatePart));
  if (certificate && out.truth->breached)
    out.d_prime = cases::d_prime_of(*certificate, *out.truth->breached);
  return out;
}

core::Result<CaseFacts> facts_of_trial(store::Store& store, const store::Objects& objects,
                                       const std::string& case_id, const trial::Header& header) {
  auto facts = case_facts(store, objects, case_id);
  const auto drilled = header.extra.find("drilled");
  if (!facts || drilled == header.extra.end()) return facts;
  facts->truth.reset();
  facts->d_prime.reset();
  if (!drilled->is_string()) return facts;
  auto trial = TRY(store.read(
      [&](store::Reading& tx) { return store::trial_of(tx, drilled->get<std::string>()); }));
  facts->truth = truth_of_drilling(trial, case_id);
  return facts;
}

}  // namespace jobs
}  // namespace tractus
