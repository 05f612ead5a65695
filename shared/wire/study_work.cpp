#include "wire/study_work.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace wire {
namespace {
constexpr std::size_t kMaxStudyName = 32, kMaxStudySealed = 64 * 1024, kMaxTrials = 1000;
constexpr long kMaxStudyCount = 100'000;

bool truth_of(core::Fields& fields, const char* key) {
  const core::Json* found = fields.member(key);
  if (found && !found->is_boolean()) fields.wrong(key, "true or false is expected");
  return found && found->is_boolean() && found->get<bool>();
}
}  // namespace

bool is_study_name(std::string_view text) noexcept {
  return !text.empty() && text.size() <= kMaxStudyName && std::ranges::all_of(text, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
           c == '_';
  });
}

core::Json SealedTrial::to_json() const {
  return {{"slot", slot}, {"number", number}, {"sealed", sealed}};
}

core::Result<SealedTrial> SealedTrial::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  SealedTrial out;
  out.slot = fields.text("slot", 64);
  if (!core::is_sha256(out.slot)) fields.wrong("slot", "64 hexadecimal characters are expected");
  out.number = static_cast<std::uint64_t>(fields.integer("number", 1, kMaxStudyCount));
  out.sealed = fields.text("sealed", kMaxStudySealed);
  TRY(fields.done());
  return out;
}

core::Json StudyWork::to_json() const {
  core::Json list = core::Json::array();
  for (const SealedTrial& trial : trials) list.push_back(trial.to_json());
  return {{"study", study},
          {"participant", participant},
          {"simulated", simulated},
          {"experience_years", experience_years ? core::Json(*experience_years) : core::Json()},
          {"unfinished", unfinished},
          {"planned", planned},
          {"trials", list}};
}

core::Result<StudyWork> StudyWork::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  StudyWork out;
  out.study = fields.text("study", kMaxStudyName);
  out.participant = fields.text("participant", kMaxStudyName);
  out.simulated = truth_of(fields, "simulated");
  const core::Json* years = fields.member("experience_years");
  if (years && !years->is_null())
    out.experience_years = fields.number("experience_years", 0.0, 80.0);
  out.unfinished = static_cast<std::uint64_t>(fields.integer("unfinished", 0, kMaxStudyCount));
  out.planned = static_cast<std::uint64_t>(fields.integer("planned", 0, kMaxStudyCount));
  const core::Json* list = fields.member("trials");
  if (list && (!list->is_array() || list->size() > kMaxTrials))
    fields.wrong("trials", "an array is expected");
  TRY(fields.done());
  for (const core::Json& one : *list) {
    auto trial = TRY(SealedTrial::from_json(one, where + "/trials"));
    out.trials.push_back(std::move(trial));
  }
  return out;
}

}  // namespace wire
}  // namespace tractus
