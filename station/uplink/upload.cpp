#include "station/uplink/upload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/try.hpp"
#include "wire/messages.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {
constexpr std::uint64_t kChunk_bytes = 1u << 20;
static_assert(kChunk_bytes <= wire::kMaxChunk_bytes);
constexpr int kMaxCorrections =
    5;  // wrong offsets in a row before the server is not believed any more

core::Result<wire::UploadState> state_of(const Request& request,
                                         const core::Result<HttpResponse>& answer) {
  if (!answer) return answer.error();
  auto json = TRY(json_of(request, *answer));
  return wire::UploadState::from_json(json, "the server's answer: ");
}

core::Result<wire::UploadState> announce(Server& server, const std::string& path,
                                         const OutboxEntry& entry) {
  const std::string text =
      wire::UploadAnnouncement{entry.case_id, entry.size_bytes, entry.sha256}.to_json().dump();
  const Request request{.method = "PUT",
                        .path = path,
                        .headers = {{"Content-Type", "application/json"}},
                        .body = core::bytes_of(text)};
  return state_of(request, server.send(request));
}

/// A chunk was sent at a place the server does not stand at: where it does.
std::optional<std::uint64_t> corrected_offset(const core::Result<HttpResponse>& answer) {
  if (!answer || answer->status != 409) return std::nullopt;
  const auto json = core::parse_json(core::text_of(answer->body), "answer");
  if (!json || !json->is_object() || !json->contains("offset_bytes") ||
      !(*json)["offset_bytes"].is_number_unsigned())
    return std::nullopt;
  return (*json)["offset_bytes"].get<std::uint64_t>();
}

core::Result<core::Bytes> read_piece(std::ifstream& file, const fs::path& path,
                                     std::uint64_t offset, std::uint64_t size) {
  core::Bytes piece(size);
  file.clear();
  file.seekg(static_cast<std::streamoff>(offset));
  file.read(reinterpret_cast<char*>(piece.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uint64_t>(file.gcount()) != size)
    return core::Error{core::Errc::corrupt,
                       fmt::format("{}: shorter than when it was queued", path.string())};
  return piece;
}

core::Result<HttpResponse> send_chunk(Server& server, const std::string& path, std::uint64_t offset,
                                      core::ByteView chunk, Request& request) {
  request = {.method = "PATCH",
             .path = fmt::format("{}?offset_bytes={}", path, offset),
             .headers = {{"Content-Type", "application/octet-stream"},
                         {"X-Crc32c", fmt::format("{:08x}", core::crc32c(chunk))}},
             .body = chunk};
  return server.send(request);
}

core::Error confused(const OutboxEntry& entry, std::uint64_t offset) {
  return {core::Errc::unavailable,
          fmt::format("upload of {}: the server's offset {} makes no sense for {} bytes",
                      entry.trial_id, offset, entry.size_bytes)};
}

/// Sends what the server lacks. Leaves `entry.offset_bytes` at what was acknowledged.
core::Result<void> send_rest(Server& server, const std::string& path, const fs::path& trial_file,
                             OutboxEntry& entry, const core::Progress& progress) {
  std::ifstream file(trial_file, std::ios::binary);
  if (!file)
    return core::Error{core::Errc::not_found, fmt::format("{}: cannot open", trial_file.string())};
  int corrections = 0;
  while (entry.offset_bytes < entry.size_bytes) {
    const std::uint64_t size = std::min(kChunk_bytes, entry.size_bytes - entry.offset_bytes);
    auto piece = TRY(read_piece(file, trial_file, entry.offset_bytes, size));
    Request request;
    const auto answer = send_chunk(server, path, entry.offset_bytes, piece, request);
    if (const auto offset = corrected_offset(answer); offset && ++corrections <= kMaxCorrections) {
      if (*offset > entry.size_bytes) return confused(entry, *offset);
      entry.offset_bytes = *offset;
      continue;
    }
    const auto state = TRY(state_of(request, answer));
    if (state.offset_bytes <= entry.offset_bytes || state.offset_bytes > entry.size_bytes)
      return confused(entry, state.offset_bytes);
    entry.offset_bytes = state.offset_bytes;
    corrections = 0;
    if (progress && !progress(double(entry.offset_bytes) / double(entry.size_bytes)))
      return core::Error{core::Errc::cancelled, "the upload was stopped"};
  }
  return {};
}

std::string note_of(const std::optional<ClockOffset>& offset) {
  if (!offset) return {};
  return core::Json{{"clock_offset_s", offset->offset_s}, {"clock_error_s", offset->error_s}}
      .dump();
}

}  // namespace

core::Result<void> upload_trial(Server& server, const fs::path& trial_file, OutboxEntry& entry,
                                const core::Progress& progress,
                                const std::optional<ClockOffset>& offset,
                                const std::function<bool()>& may_commit) {
  const std::string path = "/api/v1/uploads/" + entry.trial_id;
  auto state = TRY(announce(server, path, entry));
  if (state.offset_bytes > entry.size_bytes) return confused(entry, state.offset_bytes);
  entry.offset_bytes = state.offset_bytes;
  if (state.state != trial::UploadPhase::complete) {
    TRY(send_rest(server, path, trial_file, entry, progress));
    if (may_commit && !may_commit())
      return core::Error{core::Errc::cancelled, "an older trial waits for the server"};
    const std::string note = note_of(offset);
    const Request request{.method = "POST",
                          .path = path + "/commit",
                          .headers = {{"Content-Type", "application/json"}},
                          .body = core::bytes_of(note)};
    auto committed = TRY(state_of(request, server.send(request)));
    if (committed.state != trial::UploadPhase::complete)
      return core::Error{
          core::Errc::unavailable,
          fmt::format("upload of {}: not complete after the commit", entry.trial_id)};
  }
  entry.offset_bytes = entry.size_bytes;
  entry.state = OutboxState::complete;
  return {};
}

}  // namespace uplink
}  // namespace tractus
