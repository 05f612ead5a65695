/// What a self-test or a calibration found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"

namespace tractus::check {

enum class Bound : std::uint8_t { at_most, at_least };

/// One question and its answer. `value` and `limit` are in `unit`, SI.
struct Finding {
  std::string name = {};  ///< "direction along x (to the operator)"; no two of a test share one
  bool passed = false;
  std::optional<double> value = {}, limit = {};
  Bound bound = Bound::at_most;  ///< what the limit is, for a person
  std::string unit = {};         ///< "m", "s", …; empty with no value, and of a share
  std::string words = {};        ///< one line: what was done and seen, what to do

  core::Json to_json() const;
};

/// "12 µs", "2.8 mm", "0.04 %" of SI; a share has no unit.
std::string spelled(double value, const std::string& unit);
/// "0.21 ms"; empty without a value.
std::string found_of(const Finding& finding);
/// "at most 0.25 ms"; empty without a limit.
std::string wanted_of(const Finding& finding);
/// "2026-03-01" of microseconds since 1970.
std::string day_of(std::int64_t utc_us);

struct SelfTest {
  std::int64_t at_utc_us = 0;
  std::string device = {};  ///< as it calls itself
  bool simulated = false;
  std::vector<Finding> findings = {};

  bool passed() const;
  core::Json to_json() const;  ///< as the server takes it
};

enum class Tested { machine, simulation };

struct Calibration {
  std::int64_t at_utc_us = 0, due_utc_us = 0;
  std::string kind = {};  ///< the device's id
  std::string who = {};
  std::string words = {};  ///< what was done and found
  bool simulated = false;  ///< no machine was calibrated
  /// Of a rig: where its sensor stood with nobody on the probe.
  std::optional<double> zero_N = {}, zero_Nm = {};

  core::Json to_json() const;
  core::Json to_report() const;  ///< as the server takes it
  static core::Result<Calibration> from_json(const core::Json& json, const std::string& where);
  /// The file in the station's folder that holds a device's last one. Nothing when there is none.
  /// Errors: bad_input naming the field.
  static core::Result<std::optional<Calibration>> read(const std::filesystem::path& file);
};

/// One line when somebody should know before a trial: due within a week, overdue, of a simulation
/// that stood in for the device. Empty otherwise.
std::string due_warning(const Calibration& last, std::int64_t now_utc_us);

/// What goes to the server, and onto paper.
struct Report {
  std::optional<SelfTest> self_test = {};
  std::optional<Calibration> calibration = {};
  std::vector<Finding> checks = {};  ///< of a calibration; on the page alone
  std::string version = {};
  std::uint64_t free_disk_bytes = 0;

  core::Json to_json() const;
  /// Into a file of its own in `folder` (made when missing), names in order of time. Errors: io.
  core::Result<std::filesystem::path> leave(const std::filesystem::path& folder) const;
  /// A page to print: one file, no script, nothing loaded.
  std::string to_html(const std::string& station) const;
};

}  // namespace tractus::check
