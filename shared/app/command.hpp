/// One command of `tractus`, one file in commands/.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::commands {

/// 0: done. 1: the answer is "no". An Error becomes one line on standard error and exit 2.
using Outcome = core::Result<int>;

struct Command {
  std::string name;     ///< "import"
  std::string summary;  ///< one line
  std::string example;  ///< shown at the end of --help
  /// Adds its options to `app`; the returned function runs after parsing. Options live in what it
  /// captures.
  std::function<std::function<Outcome()>(CLI::App& app)> make;
};

/// Every command, in file-name order.
std::vector<Command> all();

}  // namespace tractus::commands
