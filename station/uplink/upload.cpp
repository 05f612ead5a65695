#include "station/uplink/upload.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/errc_words.hpp"
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

bool later_helps(core::Errc code) {  // worth trying again later
  return code == core::Errc::unavailable || code == core::Errc::cancelled ||
         code == core::Errc::io || code == core::Errc::too_large;
}

/// A trial's upload as a trace: a span for all its tries, and one for each request, which says to
/// the server whose child its own is.
class TracedServer final : public Server {
 public:
  TracedServer(Server& server, tracing::Tracer* tracer, const OutboxEntry& entry)
      : server_(server),
        tracer_(tracer),
        trial_id_(entry.trial_id),
        span_(tracer, "upload trial", tracing::SpanKind::internal, std::nullopt) {
    span_.set("tractus.trial.size_bytes", entry.size_bytes);
  }
  core::Result<HttpResponse> send(const Request& request) override {
    if (!tracer_) return server_.send(request);
    tracing::Span span(tracer_, request.method + " " + pattern_of(request.path),
                       tracing::SpanKind::client, span_.context());
    Request sent = request;
    sent.headers.emplace_back("traceparent", span.traceparent());
    auto answer = server_.send(sent);
    span.set("http.request.method", request.method);
    span.set("http.request.body.size", request.body.size());
    if (answer) span.set("http.response.status_code", answer->status);
    if (!answer) span.set_failed(std::string(core::name(answer.error().code)));
    if (answer && answer->status >= 400) span.set_failed(std::to_string(answer->status));
    return answer;
  }
  void note(const core::Result<void>& outcome) {
    span_.set_failed(outcome ? "" : std::string(core::name(outcome.error().code)));
  }

 private:
  /// Without the trial's id and the query.
  std::string pattern_of(const std::string& path) const {
    std::string out = path.substr(0, path.find('?'));
    if (const auto at = out.find(trial_id_); at != std::string::npos)
      out.replace(at, trial_id_.size(), "{trial_id}");
    return out;
  }

  Server& server_;
  tracing::Tracer* tracer_;
  const std::string trial_id_;
  tracing::Span span_;
};
}  // namespace

core::Result<void> upload_trial(Server& server, const fs::path& trial_file, OutboxEntry& entry,
                                const core::Progress& progress,
                                const std::optional<ClockOffset>& offset) {
  const std::string path = "/api/v1/uploads/" + entry.trial_id;
  auto state = TRY(announce(server, path, entry));
  if (state.offset_bytes > entry.size_bytes) return confused(entry, state.offset_bytes);
  entry.offset_bytes = state.offset_bytes;
  if (state.state != trial::UploadPhase::complete) {
    TRY(send_rest(server, path, trial_file, entry, progress));
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

core::Json UploadReport::to_json() const {
  return {{"handed_over", handed_over}, {"refused", refused}, {"waiting", waiting}, {"why", why}};
}

core::Result<UploadReport> upload_all(Server& server, const Outbox& outbox,
                                      const fs::path& trials_folder, core::Clock& clock,
                                      const Patience& patience, const core::Progress& progress,
                                      const std::optional<ClockOffset>& offset,
                                      tracing::Tracer* tracer) {
  auto entries = TRY(outbox.entries());
  std::erase_if(entries,
                [](const OutboxEntry& entry) { return entry.state != OutboxState::queued; });
  UploadReport report;
  core::Instant_ns wait = patience.first_wait_ns, last_progress = clock.now();
  std::optional<TracedServer> traced;
  for (std::size_t i = 0; i < entries.size();) {
    OutboxEntry& entry = entries[i];
    if (!traced) traced.emplace(server, tracer, entry);
    const std::uint64_t before = entry.offset_bytes;
    const auto outcome = upload_trial(*traced, trials_folder / (entry.trial_id + ".ttrial"), entry,
                                      progress, offset);
    traced->note(outcome);
    if (!outcome && outcome.error().code == core::Errc::unauthorised) return outcome.error();
    const bool later = !outcome && later_helps(outcome.error().code);
    if (!outcome && !later) entry.state = OutboxState::refused, entry.reason = outcome.error().what;
    TRY(outbox.write(entry));
    if (entry.offset_bytes > before || !later)
      last_progress = clock.now(), wait = patience.first_wait_ns;
    if (!later) {
      ++(outcome ? report.handed_over : report.refused);
      traced.reset();
      ++i;
      continue;
    }
    report.why = outcome.error().what;
    if (outcome.error().code == core::Errc::cancelled ||
        clock.now() - last_progress >= patience.give_up_after_ns) {
      report.waiting = static_cast<int>(entries.size() - i);
      return report;
    }
    clock.sleep_until(clock.now() + wait);
    wait = std::min(2 * wait, patience.longest_wait_ns);
  }
  report.why.clear();
  return report;
}

}  // namespace uplink
}  // namespace tractus
