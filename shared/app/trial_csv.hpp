/// A trial's samples as a table for other programs.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "core/result.hpp"
#include "trial/trial.hpp"

namespace commands {

/// One row per sample: the columns of a palpation measurement first (so that the file can stand in
/// a measurement set: t_s, handle pose in V, the model's wrench in H), then what was rendered and
/// how the loop fared. Shortest digits that give the same number back. Written beside and put in
/// place by finish(); gone without it.
class TrialCsv {
 public:
  static core::Result<TrialCsv> create(const std::filesystem::path& path);
  ~TrialCsv();
  TrialCsv(TrialCsv&&) noexcept = default;
  void add(std::span<const trial::Sample> samples);
  core::Result<void> finish();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  TrialCsv(std::filesystem::path path, std::filesystem::path beside, std::FILE* file)
      : path_(std::move(path)), beside_(std::move(beside)), file_(file) {}
  std::filesystem::path path_, beside_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace commands
