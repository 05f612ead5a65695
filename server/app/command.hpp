/// What the commands of `tractus-server` share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::app {

using Outcome = core::Result<void>;
/// What a command does once its options are read. 0: done; 1: the answer is "no".
using Run = std::function<core::Result<int>()>;

/// One line on standard output: for a person, or JSON.
void say(bool json, const core::Json& object, const std::string& line);

struct Common {
  std::filesystem::path data;
  bool json = false;
};
/// --data and --json.
std::shared_ptr<Common> common_options(CLI::App& command);
/// --objects.
std::shared_ptr<std::string> objects_option(CLI::App& command);

// Each adds its options to `command`.
Run init_command(CLI::App& command);
Run enrol_command(CLI::App& command);
Run publish_command(CLI::App& command);
Run serve_command(CLI::App& command);
Run openapi_command(CLI::App& command);
Run backup_command(CLI::App& command);
Run restore_command(CLI::App& command);
Run verify_command(CLI::App& command);
Run anchor_command(CLI::App& command);
Run migrate_command(CLI::App& command);
Run upgrade_command(CLI::App& command);

}  // namespace tractus::app
