/// What the lab's commands share: options, the printed answer, the files they write.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "core/result.hpp"
#include "lab/io/answers.hpp"

namespace tractus::commands {

struct LabOptions {
  lab_io::Sources sources;
  std::vector<std::filesystem::path> own;  ///< files of the user's own effects
  std::filesystem::path report;            ///< empty: none
  bool json = false;
};

/// --model, --measurements, --report, --threads, --json.
void add_lab_options(CLI::App& app, LabOptions& options);

/// --effect, for commands that take effects of the user's own.
void add_own_option(CLI::App& app, LabOptions& options);

/// Opens model, own effects and measurements with a bar on a terminal.
core::Result<lab_io::Case> opened(const LabOptions& options);

/// Refuses, before any work, a file that may not be written.
core::Result<void> writable(const std::filesystem::path& file);

/// Writes model and report where they are asked for (empty paths: not), whole or not at all.
core::Result<void> write_files(const lab_io::LabResult& answer, const std::filesystem::path& model,
                               const std::filesystem::path& report);

/// For people: a sentence first, then tables.
std::string printed_comparison(const lab_io::LabResult& answer);
std::string printed_diagnosis(const lab_io::LabResult& answer);
std::string printed_fit(const lab_io::LabResult& answer);

}  // namespace tractus::commands
