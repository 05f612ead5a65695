/// A trial's samples as a table for other programs.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"
#include "trial/trial.hpp"

namespace tractus::commands {

/// One row per sample: the columns of a measurement of its rig first (so that the file can stand in
/// a measurement set), then what was rendered and how the loop fared. Shortest digits that give the
/// same number back. Written beside and put in place by finish(); gone without it.
class TrialCsv {
 public:
  static core::Result<TrialCsv> create(const std::filesystem::path& path);
  ~TrialCsv();
  TrialCsv(TrialCsv&&) noexcept = default;
  void add(const trial::Block& samples);
  /// @param rig  whose columns stand in a table of no rows.
  core::Result<void> finish(trial::Rig rig);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  TrialCsv(std::filesystem::path path, std::filesystem::path beside, std::FILE* file)
      : path_(std::move(path)), beside_(std::move(beside)), file_(file) {}
  void add_header(trial::Rig rig);
  std::filesystem::path path_, beside_;
  bool headed_ = false;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace tractus::commands
