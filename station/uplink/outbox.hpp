/// What waits to be handed over, on disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.hpp"

namespace tractus::uplink {

enum class OutboxState { queued, complete, refused };
constexpr auto words(OutboxState) {
  using enum OutboxState;
  return std::to_array<core::Word<OutboxState>>(
      {{queued, "queued"}, {complete, "complete"}, {refused, "refused"}});
}

/// One finished trial on its way: `outbox/<trial id>.json`.
struct OutboxEntry {
  std::string trial_id;
  std::string case_id;
  std::uint64_t size_bytes = 0;
  std::string sha256;              ///< of the trial file
  std::uint64_t offset_bytes = 0;  ///< what the server has said it holds
  OutboxState state = OutboxState::queued;
  std::string reason;  ///< of a refusal, one line

  core::Json to_json() const;
  static core::Result<OutboxEntry> from_json(const core::Json& json, const std::string& where);
};

class Outbox {
 public:
  explicit Outbox(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Of a sealed trial file: reads it once for size and hash. An entry that is there already stays.
  core::Result<void> queue(const std::string& trial_id, const std::string& case_id,
                           const std::filesystem::path& trial_file) const;
  bool holds(const std::string& trial_id) const;
  /// In order of the trials' ids, which sort by time. Errors: io, bad_input naming the file.
  core::Result<std::vector<OutboxEntry>> entries() const;
  core::Result<void> write(const OutboxEntry& entry) const;

 private:
  std::filesystem::path file_of(const std::string& trial_id) const;
  std::filesystem::path folder_;
};

/// SHA-256 and size of a file, read in pieces.
struct FileDigest {
  std::uint64_t size_bytes = 0;
  std::string sha256;
};
core::Result<FileDigest> digest_of(const std::filesystem::path& path);

}  // namespace tractus::uplink
