#include "wire/live.hpp"

#include <algorithm>
#include <limits>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace wire {
namespace {
constexpr long kMost = std::numeric_limits<long>::max();
constexpr double kMostForce_N = 10'000.0, kMostDepth_m = 1.0, kMostTime_s = 1e7;
constexpr double kMostOffset_s = 1e10;
constexpr std::size_t kName = 64, kWords = 400, kMostFailed = 64, kMostChecks = 128;

template <class T>
core::Json object_or_null(const std::optional<T>& value) {
  return value ? value->to_json() : core::Json();
}

/// Absent and null are the same.
bool given(core::Fields& fields, const char* key) {
  const core::Json* member = fields.member(key, false);
  return member && !member->is_null();
}
std::optional<double> number_in(core::Fields& fields, const char* key, double low, double high) {
  if (!given(fields, key)) return std::nullopt;
  return fields.number(key, low, high);
}
template <class Whole>
std::optional<Whole> whole_in(core::Fields& fields, const char* key) {
  if (!given(fields, key)) return std::nullopt;
  return static_cast<Whole>(fields.integer(key, 0, kMost));
}
std::string text_in(core::Fields& fields, const char* key, std::size_t limit) {
  return given(fields, key) ? fields.text(key, limit) : std::string();
}
bool truth_in(core::Fields& fields, const char* key) {
  const core::Json* member = fields.member(key);
  if (member && member->is_boolean()) return member->get<bool>();
  fields.wrong(key, "true or false is expected");
  return false;
}
std::optional<bool> maybe_truth_in(core::Fields& fields, const char* key) {
  if (!given(fields, key)) return std::nullopt;
  return truth_in(fields, key);
}

std::vector<std::string> lines_in(core::Fields& fields, const char* key, std::size_t limit) {
  const core::Json* list = fields.member(key);
  const bool fine = list && list->is_array() && list->size() <= kMostFailed &&
                    std::ranges::all_of(*list, [limit](const core::Json& one) {
                      return one.is_string() && one.get_ref<const std::string&>().size() <= limit;
                    });
  if (!fine) fields.wrong(key, "a list of at most 64 short texts is expected");
  return fine ? list->get<std::vector<std::string>>() : std::vector<std::string>();
}

core::Json trial_json(const LiveTrial& trial) {
  return {{"trial_id", trial.trial_id},
          {"rig", core::name(trial.rig)},
          {"case_id", trial.case_id},
          {"t_s", trial.t_s},
          {"samples", trial.samples},
          {"force_N", core::or_null(trial.force_N)},
          {"depth_m", core::or_null(trial.depth_m)},
          {"late_ticks", trial.late_ticks}};
}

core::Result<LiveTrial> trial_from(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  LiveTrial out;
  out.trial_id = fields.text("trial_id", 32);
  out.rig = fields.word<trial::Rig>("rig");
  out.case_id = fields.text("case_id", 64);
  out.t_s = fields.number("t_s", 0.0, kMostTime_s);
  out.samples = static_cast<std::uint64_t>(fields.integer("samples", 0, kMost));
  out.force_N = number_in(fields, "force_N", 0.0, kMostForce_N);
  out.depth_m = number_in(fields, "depth_m", -kMostDepth_m, kMostDepth_m);
  out.late_ticks = static_cast<std::uint64_t>(fields.integer("late_ticks", 0, kMost));
  if (!core::is_id(out.trial_id))
    fields.wrong("trial_id", "32 hexadecimal characters are expected");
  if (!core::is_sha256(out.case_id))
    fields.wrong("case_id", "64 hexadecimal characters are expected");
  TRY(fields.done());
  return out;
}

core::Result<StationReport::Check> check_from(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  StationReport::Check out;
  out.name = fields.text("name", kName);
  out.passed = truth_in(fields, "passed");
  out.value = number_in(fields, "value", -1e300, 1e300);
  out.limit = number_in(fields, "limit", -1e300, 1e300);
  out.unit = text_in(fields, "unit", 16);
  out.words = text_in(fields, "words", kWords);
  TRY(fields.done());
  return out;
}

core::Result<StationReport::SelfTest> self_test_from(const core::Json& json,
                                                     const std::string& where) {
  core::Fields fields(json, where);
  StationReport::SelfTest out;
  out.at_utc_us = fields.integer("at_utc_us", 0, kMost);
  out.passed = truth_in(fields, "passed");
  const core::Json* checks = fields.member("checks");
  const bool list = checks && checks->is_array() && checks->size() <= kMostChecks;
  if (!list) fields.wrong("checks", "a list of at most 128 is expected");
  TRY(fields.done());
  for (const core::Json& one : *checks) {
    auto check = TRY(check_from(one, where + "/checks"));
    out.checks.push_back(std::move(check));
  }
  return out;
}

core::Result<StationReport::Calibration> calibration_from(const core::Json& json,
                                                          const std::string& where) {
  core::Fields fields(json, where);
  StationReport::Calibration out;
  out.at_utc_us = fields.integer("at_utc_us", 0, kMost);
  out.due_utc_us = whole_in<std::int64_t>(fields, "due_utc_us");
  out.kind = fields.text("kind", kName);
  out.words = text_in(fields, "words", kWords);
  TRY(fields.done());
  return out;
}

}  // namespace

core::Json SelfTestSummary::to_json() const {
  return {{"at_utc_us", at_utc_us}, {"passed", passed}, {"failed", failed}};
}

core::Result<SelfTestSummary> SelfTestSummary::from_json(const core::Json& json,
                                                         const std::string& where) {
  core::Fields fields(json, where);
  SelfTestSummary out;
  out.at_utc_us = fields.integer("at_utc_us", 0, kMost);
  out.passed = truth_in(fields, "passed");
  out.failed = lines_in(fields, "failed", kName);
  TRY(fields.done());
  return out;
}

core::Json StationStatus::to_json() const {
  return {{"kind", "state"},
          {"state", core::name(state)},
          {"version", version},
          {"device", device},
          {"simulated", core::or_null(simulated)},
          {"trial", trial ? trial_json(*trial) : core::Json()},
          {"clock_offset_s", core::or_null(clock_offset_s)},
          {"clock_error_s", core::or_null(clock_error_s)},
          {"free_disk_bytes", core::or_null(free_disk_bytes)},
          {"late_share", core::or_null(late_share)},
          {"waiting_trials", core::or_null(waiting_trials)},
          {"calibration_due_utc_us", core::or_null(calibration_due_utc_us)},
          {"self_test", object_or_null(self_test)}};
}

core::Result<StationStatus> StationStatus::from_json(const core::Json& json,
                                                     const std::string& where) {
  core::Fields fields(json, where);
  StationStatus out;
  if (fields.text("kind", 16) != "state") fields.wrong("kind", "state is expected");
  out.state = fields.word<StationState>("state");
  if (out.state == StationState::away) fields.wrong("state", "a station that speaks is not away");
  out.version = text_in(fields, "version", kName);
  out.device = text_in(fields, "device", kName);
  out.simulated = maybe_truth_in(fields, "simulated");
  out.clock_offset_s = number_in(fields, "clock_offset_s", -kMostOffset_s, kMostOffset_s);
  out.clock_error_s = number_in(fields, "clock_error_s", 0.0, kMostOffset_s);
  out.free_disk_bytes = whole_in<std::uint64_t>(fields, "free_disk_bytes");
  out.late_share = number_in(fields, "late_share", 0.0, 1.0);
  out.waiting_trials = whole_in<std::uint64_t>(fields, "waiting_trials");
  out.calibration_due_utc_us = whole_in<std::int64_t>(fields, "calibration_due_utc_us");
  const core::Json* trial = given(fields, "trial") ? fields.member("trial") : nullptr;
  const core::Json* test = given(fields, "self_test") ? fields.member("self_test") : nullptr;
  TRY(fields.done());
  if (trial) {
    auto read = TRY(trial_from(*trial, where + "/trial"));
    out.trial = std::move(read);
  }
  if (test) {
    auto read = TRY(SelfTestSummary::from_json(*test, where + "/self_test"));
    out.self_test = std::move(read);
  }
  return out;
}

core::Json StationCommand::to_json() const {
  if (kind == Kind::stop) return {{"kind", core::name(kind)}, {"reason", reason}};
  return {{"kind", core::name(kind)}, {"force_N", force_N}};
}

core::Result<StationCommand> StationCommand::from_json(const core::Json& json,
                                                       const std::string& where) {
  core::Fields fields(json, where);
  StationCommand out;
  out.kind = fields.word<Kind>("kind");
  if (out.kind == Kind::stop) out.reason = fields.text("reason", kWords);
  if (out.kind == Kind::limits) out.force_N = fields.number("force_N", 0.0, kMostForce_N);
  TRY(fields.done());
  return out;
}

core::Json StationReport::SelfTest::to_json() const {
  core::Json list = core::Json::array();
  for (const Check& check : checks)
    list.push_back({{"name", check.name},
                    {"passed", check.passed},
                    {"value", core::or_null(check.value)},
                    {"unit", check.unit},
                    {"limit", core::or_null(check.limit)},
                    {"words", check.words}});
  return {{"at_utc_us", at_utc_us}, {"passed", passed}, {"checks", list}};
}

SelfTestSummary StationReport::SelfTest::summary() const {
  SelfTestSummary out{at_utc_us, passed, {}};
  for (const Check& check : checks)
    if (!check.passed && out.failed.size() < kMostFailed) out.failed.push_back(check.name);
  return out;
}

core::Json StationReport::Calibration::to_json() const {
  return {{"at_utc_us", at_utc_us},
          {"due_utc_us", core::or_null(due_utc_us)},
          {"kind", kind},
          {"words", words}};
}

core::Json StationReport::to_json() const {
  core::Json out{{"version", version}, {"free_disk_bytes", core::or_null(free_disk_bytes)}};
  if (self_test) out["self_test"] = self_test->to_json();
  if (calibration) out["calibration"] = calibration->to_json();
  if (!refused.empty()) out["refused"] = refused;
  return out;
}

core::Result<StationReport> StationReport::from_json(const core::Json& json,
                                                     const std::string& where) {
  core::Fields fields(json, where);
  StationReport out;
  out.version = text_in(fields, "version", kName);
  out.free_disk_bytes = whole_in<std::uint64_t>(fields, "free_disk_bytes");
  const core::Json* test = given(fields, "self_test") ? fields.member("self_test") : nullptr;
  const core::Json* made = given(fields, "calibration") ? fields.member("calibration") : nullptr;
  if (given(fields, "refused")) out.refused = lines_in(fields, "refused", kWords);
  TRY(fields.done());
  if (test) {
    auto read = TRY(self_test_from(*test, where + "/self_test"));
    out.self_test = std::move(read);
  }
  if (made) {
    auto read = TRY(calibration_from(*made, where + "/calibration"));
    out.calibration = std::move(read);
  }
  return out;
}

}  // namespace wire
}  // namespace tractus
