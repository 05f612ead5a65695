/// What the sources of the options share. For them alone.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <map>

#include "station/app/options.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus::app {

/// A subcommand that is done by `deed`.
CLI::App* add_command(CLI::App& app, Options& options, CommandFunction command, const char* name,
                      const char* what);
void add_data(CLI::App& app, Options& options, bool needed);
void add_server(CLI::App& app, Options& options, bool needed);
/// Says why on standard error; the exit code of wrong use.
int refuse(const std::string& why);
const std::map<std::string, Show>& shows();  ///< of --view

/// A number from `low` to `high`, which CLI::Range lets "nan" be.
inline CLI::Validator between(double low, double high) {
  const CLI::Range range(low, high);
  return CLI::Validator(
      [low, high](std::string& given) {
        double value = 0.0;
        if (CLI::detail::lexical_cast(given, value) && value >= low && value <= high)
          return std::string();
        return fmt::format("{}: a number from {} to {} is expected", given, low, high);
      },
      range.get_description());
}

/// One of these words; neither help nor a refusal shows the numbers behind them.
template <class T>
CLI::Validator word_of(const std::map<std::string, T>& words) {
  std::string all;
  for (const auto& [word, _] : words) all += (all.empty() ? "" : ", ") + word;
  return CLI::Validator(
      [words, all](std::string& given) {
        const auto found = words.find(given);
        if (found == words.end()) return given + ": one of " + all + " is expected";
        given = std::to_string(static_cast<int>(found->second));
        return std::string();
      },
      "{" + all + "}");
}

/// --device: one of these. What it is for is said in `help`.
CLI::Option* add_device(CLI::App& app, std::string& device, const std::string& help,
                        const std::vector<devices::DeviceInfo>& from);
/// --sdk and --address, of the devices that are found by them.
void add_sdk(CLI::App& app, Options& options);
void add_address(CLI::App& app, Options& options);

/// What a technician does at a station: limits, self-test, calibrate, align, record.
void add_technician(CLI::App& app, Options& options);
/// What does not fit together in those is refused.
std::optional<int> check_technician(const Options& options);

}  // namespace tractus::app
