#include "station/uplink/outbox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {
constexpr long kMaxTrial_bytes = 8l << 30;
constexpr std::size_t kPiece_bytes = 1u << 20;
}  // namespace

core::Json OutboxEntry::to_json() const {
  return {{"trial_id", trial_id}, {"case_id", case_id},           {"size_bytes", size_bytes},
          {"sha256", sha256},     {"offset_bytes", offset_bytes}, {"state", core::name(state)},
          {"reason", reason}};
}

core::Result<OutboxEntry> OutboxEntry::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  OutboxEntry out;
  out.trial_id = fields.text("trial_id", 32);
  out.case_id = fields.text("case_id", 64);
  out.size_bytes = static_cast<std::uint64_t>(fields.integer("size_bytes", 1, kMaxTrial_bytes));
  out.sha256 = fields.text("sha256", 64);
  out.offset_bytes = static_cast<std::uint64_t>(fields.integer("offset_bytes", 0, kMaxTrial_bytes));
  out.state = fields.word<OutboxState>("state");
  out.reason = fields.text_or("reason", "");
  if (!core::is_id(out.trial_id))
    fields.wrong("trial_id", "32 hexadecimal characters are expected");
  if (!core::is_sha256(out.case_id))
    fields.wrong("case_id", "64 hexadecimal characters are expected");
  if (!core::is_sha256(out.sha256))
    fields.wrong("sha256", "64 hexadecimal characters are expected");
  TRY(fields.done());
  return out;
}

fs::path Outbox::file_of(const std::string& trial_id) const {
  return folder_ / (trial_id + ".json");
}

bool Outbox::holds(const std::string& trial_id) const {
  std::error_code ignored;
  return fs::exists(file_of(trial_id), ignored);
}

core::Result<void> Outbox::write(const OutboxEntry& entry) const {
  return core::write_json(file_of(entry.trial_id), entry.to_json());
}

core::Result<void> Outbox::queue(const std::string& trial_id, const std::string& case_id,
                                 const fs::path& trial_file) const {
  if (holds(trial_id)) return {};
  auto digest = TRY(digest_of(trial_file));
  return write({.trial_id = trial_id,
                .case_id = case_id,
                .size_bytes = digest.size_bytes,
                .sha256 = digest.sha256,
                .reason = {}});
}

core::Result<std::vector<OutboxEntry>> Outbox::entries() const {
  std::vector<OutboxEntry> out;
  std::error_code failure;
  for (const auto& file : fs::directory_iterator(folder_, failure)) {
    if (file.path().extension() != ".json") continue;
    auto json = TRY(core::read_json(file.path()));
    auto entry = TRY(OutboxEntry::from_json(json, file.path().string() + ": "));
    out.push_back(std::move(entry));
  }
  if (failure)
    return core::Error{core::Errc::io, fmt::format("{}: {}", folder_.string(), failure.message())};
  std::ranges::sort(out, {}, &OutboxEntry::trial_id);
  return out;
}

core::Result<FileDigest> digest_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return core::system_error(path, "cannot open");
  core::Sha256 hash;
  FileDigest out;
  core::Bytes piece(kPiece_bytes);
  while (file) {
    file.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(piece.size()));
    const auto got = static_cast<std::size_t>(file.gcount());
    hash.add(core::ByteView(piece).first(got));
    out.size_bytes += got;
  }
  if (file.bad()) return core::system_error(path, "cannot read");
  out.sha256 = hash.hex();
  return out;
}

}  // namespace uplink
}  // namespace tractus
