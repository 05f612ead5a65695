#include "station/check/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus {
namespace check {
namespace {
constexpr std::size_t kWords = 400;  // that the server takes
constexpr std::int64_t kSoon_us = 7ll * 86'400'000'000;
constexpr const char* kFormat = "tractus-calibration/1";

core::Json number_or_null(const std::optional<double>& value) {
  return value ? core::Json(*value) : core::Json();
}

std::optional<double> number_in(core::Fields& fields, const char* key) {
  if (!fields.has(key)) return std::nullopt;
  return fields.number(key, -1e6, 1e6);
}
}  // namespace

core::Json Finding::to_json() const {
  return {{"name", name},
          {"passed", passed},
          {"value", number_or_null(value)},
          {"unit", unit},
          {"limit", number_or_null(limit)},
          {"words", core::one_line(words, kWords)}};
}

std::string spelled(double value, const std::string& unit) {
  struct Prefix {
    const char *of, *as;
    double factor, below;  ///< for values below
  };
  static constexpr Prefix kPrefixes[] = {{"s", "µs", 1e6, 1e-3},     {"s", "ms", 1e3, 1.0},
                                         {"m", "mm", 1e3, 1.0},      {"rad", "mrad", 1e3, 1.0},
                                         {"N·m", "mN·m", 1e3, 0.05}, {"B", "GB", 1e-9, 1e300}};
  const auto shown = [](double number) {
    return std::abs(number) < 5e-4 ? std::string("0") : fmt::format("{:.3g}", number);
  };
  for (const Prefix& p : kPrefixes)
    if (unit == p.of && std::abs(value) < p.below) return shown(value * p.factor) + " " + p.as;
  if (unit.empty()) return shown(100.0 * value) + " %";
  return shown(value) + " " + unit;
}

std::string found_of(const Finding& finding) {
  return finding.value ? spelled(*finding.value, finding.unit) : "";
}

std::string wanted_of(const Finding& finding) {
  if (!finding.limit) return "";
  return fmt::format("at {} {}", finding.bound == Bound::at_most ? "most" : "least",
                     spelled(*finding.limit, finding.unit));
}

std::string day_of(std::int64_t utc_us) { return core::utc_text(utc_us).substr(0, 10); }

bool SelfTest::passed() const {
  return !findings.empty() && std::ranges::all_of(findings, &Finding::passed);
}

core::Json SelfTest::to_json() const {
  core::Json checks = core::Json::array();
  // What was tested is told as a check: of a report nothing else says whether a machine was.
  if (!device.empty() && std::ranges::find(findings, "device", &Finding::name) == findings.end())
    checks.push_back(
        Finding{.name = "device",
                .passed = true,
                .words = device + (simulated ? " (SIMULATED: no machine was tested)" : "")}
            .to_json());
  for (const Finding& f : findings) checks.push_back(f.to_json());
  return {{"at_utc_us", at_utc_us}, {"passed", passed()}, {"checks", checks}};
}

core::Json Calibration::to_json() const {
  core::Json out{
      {"format", kFormat}, {"at_utc_us", at_utc_us}, {"due_utc_us", due_utc_us}, {"kind", kind},
      {"who", who},        {"words", words}};
  if (simulated) out["simulated"] = true;
  if (zero_N) out["zero_N"] = *zero_N;
  if (zero_Nm) out["zero_Nm"] = *zero_Nm;
  return out;
}

core::Json Calibration::to_report() const {
  return {{"at_utc_us", at_utc_us},
          {"due_utc_us", due_utc_us},
          {"kind", kind},
          {"words", core::one_line(fmt::format("by {}: {}", who, words), kWords)}};
}

core::Result<Calibration> Calibration::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  constexpr long kFar = 9'000'000'000'000'000;
  if (fields.text("format") != kFormat)
    fields.wrong("format", fmt::format("{} is expected", kFormat));
  Calibration out{.at_utc_us = fields.integer("at_utc_us", 0, kFar),
                  .due_utc_us = fields.integer("due_utc_us", 0, kFar),
                  .kind = fields.text("kind", 64),
                  .who = fields.text("who", 64),
                  .words = fields.text("words"),
                  .zero_N = number_in(fields, "zero_N"),
                  .zero_Nm = number_in(fields, "zero_Nm")};
  const core::Json* simulated = fields.member("simulated", false);  // older ones do not say
  if (simulated && !simulated->is_boolean()) fields.wrong("simulated", "true or false is expected");
  out.simulated = simulated && simulated->is_boolean() && simulated->get<bool>();
  TRY(fields.done());
  return out;
}

core::Result<std::optional<Calibration>> Calibration::read(const std::filesystem::path& file) {
  auto json = core::read_json(file);
  if (!json && json.error().code == core::Errc::not_found) return std::optional<Calibration>();
  if (!json) return json.error();
  auto read = TRY(from_json(*json, file.string() + ": "));
  return std::optional(read);
}

std::string due_warning(const Calibration& last, std::int64_t now_utc_us) {
  if (last.simulated && !devices::is_simulated(last.kind))
    return fmt::format(
        "the calibration of {} was of a SIMULATED one: run `tractus-station calibrate`", last.kind);
  if (now_utc_us < last.due_utc_us - kSoon_us) return "";
  const bool over = now_utc_us >= last.due_utc_us;
  return fmt::format("the calibration of {} {} {}: run `tractus-station calibrate`", last.kind,
                     over ? "is OVERDUE since" : "is due on", day_of(last.due_utc_us));
}

core::Json Report::to_json() const {
  core::Json out{{"version", version}, {"free_disk_bytes", free_disk_bytes}};
  if (self_test) out["self_test"] = self_test->to_json();
  if (calibration) out["calibration"] = calibration->to_report();
  return out;
}

core::Result<std::filesystem::path> Report::leave(const std::filesystem::path& folder) const {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  const std::int64_t at = self_test ? self_test->at_utc_us : calibration->at_utc_us;
  const std::filesystem::path file =
      folder / fmt::format("{:016}-{}.json", at, core::new_id().substr(0, 8));
  TRY(core::write_json(file, to_json()));
  return file;
}

}  // namespace check
}  // namespace tractus
