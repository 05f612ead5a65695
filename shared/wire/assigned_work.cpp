#include "wire/assigned_work.hpp"

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "wire/study_work.hpp"

namespace tractus {
namespace wire {
namespace {
constexpr long kMaxCount = 100'000;
constexpr std::size_t kMaxName = 200, kMaxSealed = 64 * 1024;
}  // namespace

core::Json AssignedTrial::to_json() const {
  core::Json out{{"slot", slot},       {"rig", core::name(rig)},
                 {"name", name},       {"assignment", assignment},
                 {"number", number},   {"planned", planned},
                 {"case_id", case_id}, {"sealed", sealed}};
  if (drills) out["tool"] = core::name(trial::Tool::burr);
  if (!drilled.empty()) out["drilled"] = drilled;
  return out;
}

core::Result<AssignedTrial> AssignedTrial::from_json(const core::Json& json,
                                                     const std::string& where) {
  core::Fields fields(json, where);
  AssignedTrial out;
  out.slot = fields.text("slot", 64);
  if (!core::is_sha256(out.slot)) fields.wrong("slot", "64 hexadecimal characters are expected");
  out.rig = fields.word<trial::Rig>("rig");
  out.name = fields.text("name", kMaxName);
  out.assignment = fields.text("assignment", kMaxName);
  out.number = static_cast<std::uint64_t>(fields.integer("number", 1, kMaxCount));
  out.planned = static_cast<std::uint64_t>(fields.integer("planned", 1, kMaxCount));
  out.case_id = fields.text("case_id", 64);
  if (out.rig == trial::Rig::palpation && !core::is_sha256(out.case_id))
    fields.wrong("case_id", "64 hexadecimal characters are expected");
  out.sealed = fields.text("sealed", kMaxSealed);
  out.drills = fields.word_or("tool", trial::Tool::probe) == trial::Tool::burr;
  out.drilled = fields.text_or("drilled", "", 64);
  if (!out.drilled.empty() && !core::is_id(out.drilled))
    fields.wrong("drilled", "a trial's id is expected");
  if ((out.drills || !out.drilled.empty()) && out.rig != trial::Rig::palpation)
    fields.wrong("rig", "palpation is expected: the other rig drills nothing");
  if (out.drills && !out.drilled.empty())
    fields.wrong("drilled", "is felt with the probe: a burr begins on whole bone");
  TRY(fields.done());
  return out;
}

core::Json AssignedWork::to_json() const {
  return {{"participant", participant},
          {"left", left},
          {"trial", trial ? trial->to_json() : core::Json()}};
}

core::Result<AssignedWork> AssignedWork::from_json(const core::Json& json,
                                                   const std::string& where) {
  core::Fields fields(json, where);
  AssignedWork out;
  out.participant = fields.text("participant", 32);
  if (!out.participant.empty() && !is_study_name(out.participant))
    fields.wrong("participant", "a pseudonym is expected");
  out.left = static_cast<std::uint64_t>(fields.integer("left", 0, kMaxCount));
  const core::Json* trial = fields.member("trial");
  TRY(fields.done());
  if (trial->is_null()) return out;
  auto read = TRY(AssignedTrial::from_json(*trial, where + "/trial"));
  out.trial = std::move(read);
  return out;
}

}  // namespace wire
}  // namespace tractus
