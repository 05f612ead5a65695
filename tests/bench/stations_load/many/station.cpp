#include "tests/bench/stations_load/many/station.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/uplink/upload.hpp"
#include "tests/bench/stations_load/station.hpp"
#include "trial/frames.hpp"
#include "wire/live.hpp"
#include "wire/messages.hpp"

namespace tractus {
namespace many {
namespace fs = std::filesystem;
namespace {

double many_since_s(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}
Clock::duration duration_of(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

core::Result<Template> Template::make(const fs::path& folder, const std::string& case_id,
                                      const Options& options, unsigned seed) {
  Template out;
  out.id_ = core::new_id();
  auto bytes =
      TRY(load::trial_bytes(folder, out.id_, case_id, options.rate_Hz, options.trial_s, seed));
  const fs::path file = folder / (out.id_ + ".ttrial");
  TRY(core::write_file(file, core::bytes_of(bytes)));
  auto reader = TRY(trial::FrameReader::open(file, 1ull << 30));
  TRY(reader.next());
  out.header_ = core::text_of(reader.payload());
  const std::uint64_t first_end = reader.position();
  while (reader.type() != trial::FrameType::end) {
    const auto step = TRY(reader.next());
    if (step != trial::FrameReader::Step::frame)
      return core::Error{core::Errc::corrupt, "the template of a trial has no end"};
  }
  out.body_ = bytes.substr(first_end, reader.offset() - first_end);
  out.end_sequence_ = reader.next_sequence() - 1;
  out.samples_ = static_cast<std::uint64_t>(options.trial_s * options.rate_Hz);
  fs::remove(file);
  return out;
}

core::Result<uplink::FileDigest> Template::write(const fs::path& file,
                                                 const std::string& id) const {
  std::string header = header_;
  header.replace(header.find(id_), id_.size(), id);
  std::string all(trial::kMagic);
  all += core::text_of(
      trial::frame_bytes(trial::FrameType::header, 0, core::bytes_of(std::string_view(header))));
  all += body_;
  const auto end = trial::end_payload(samples_, core::sha256(core::bytes_of(all)));
  all += core::text_of(trial::frame_bytes(trial::FrameType::end, end_sequence_, end));
  const trial::Descriptor out(::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!out || !trial::write_all(out.fd(), core::bytes_of(all)))
    return core::system_error(file, "cannot write");
  return uplink::FileDigest{all.size(), core::sha256(core::bytes_of(all))};
}

struct Station::OneTrial {
  uplink::OutboxEntry entry;
  fs::path file;
  std::uint64_t acknowledged = 0;
};

Station::Station(const Setup& setup, const Options& options, const Template& recorded,
                 std::size_t number, Clock::time_point begun)
    : setup_(setup),
      options_(options),
      recorded_(recorded),
      number_(number),
      begun_(begun),
      thread_([this] { run(); }) {}

Tally Station::finish() {
  thread_.join();
  return std::move(tally_);
}

void Station::sleep_until(Clock::time_point when) const {
  constexpr std::chrono::milliseconds kStep{1000};
  while (!ending_ && Clock::now() < when)
    std::this_thread::sleep_until(std::min(when, Clock::now() + kStep));
}

bool Station::wait_after(const core::Error& error, int& attempt) {
  using core::Errc;
  if (error.code != Errc::unavailable && error.code != Errc::io && error.code != Errc::too_large) {
    tally_.failures.push_back(error.what);
    return false;
  }
  if (attempt > 20) {
    tally_.failures.push_back("given up after 20 tries: " + error.what);
    return false;
  }
  ++tally_.retries;
  const uplink::Patience patience;
  const auto wait = std::min(patience.first_wait_ns << std::min(attempt++, 6),
                             std::int64_t{patience.longest_wait_ns});
  std::this_thread::sleep_for(std::chrono::nanoseconds(wait));
  return true;
}

void Station::run() {
  auto server = uplink::HttpServer::make(setup_.url(), setup_.token(number_), setup_.authority());
  if (!server) return tally_.failures.push_back(server.error().what);
  const double share = double(number_) / options_.stations;
  auto next = begun_ + duration_of(share * options_.cycle_s());
  for (sleep_until(next); !ending_; sleep_until(next)) {
    next += duration_of(options_.cycle_s());
    record(**server);
    in_trial_ = false;
  }
}

void Station::record(uplink::Server& server) {
  OneTrial trial;
  trial.entry.trial_id = core::new_id();
  trial.entry.case_id = setup_.case_id();
  trial.file = test_support::place_of(test_support::Durable::no) /
               ("many-" + trial.entry.trial_id + ".ttrial");
  const auto digest = recorded_.write(trial.file, trial.entry.trial_id);
  if (!digest) return tally_.failures.push_back(digest.error().what);
  trial.entry.size_bytes = digest->size_bytes;
  trial.entry.sha256 = digest->sha256;
  {
    const std::lock_guard held(mutex_);
    trial_id_ = trial.entry.trial_id;
    trial_begun_ = Clock::now();
  }
  in_trial_ = true;
  const auto pieces = static_cast<std::uint64_t>(std::ceil(options_.trial_s / options_.between_s));
  bool fine = announce(server, trial);
  auto due = Clock::now();
  for (std::uint64_t i = 1; fine && i <= pieces; ++i) {
    due += duration_of(options_.between_s);
    sleep_until(due);
    if (ending_) break;  // the rest goes with the commit
    const auto first = Clock::now();
    fine = send_piece(server, trial, trial.entry.size_bytes * i / pieces);
    if (fine)
      tally_.pieces.push_back(
          {due, many_since_s(first), std::chrono::duration<double>(first - due).count()});
  }
  if (fine && commit(server, trial))
    tally_.trials.push_back(
        {trial.entry.trial_id, trial.entry.sha256, trial.entry.size_bytes, recorded_.samples()});
  fs::remove(trial.file);
}

bool Station::announce(uplink::Server& server, const OneTrial& trial) {
  const std::string said =
      wire::UploadAnnouncement{trial.entry.case_id, trial.entry.size_bytes, trial.entry.sha256}
          .to_json()
          .dump();
  const uplink::Request request{.method = "PUT",
                                .path = "/api/v1/uploads/" + trial.entry.trial_id,
                                .headers = {{"Content-Type", "application/json"}},
                                .body = core::bytes_of(said)};
  for (int attempt = 0;;) {
    const auto answer = server.send(request);
    if (answer && answer->status == 200) return true;
    if (!wait_after(answer ? uplink::error_of(request, *answer) : answer.error(), attempt))
      return false;
  }
}

/// Until the server acknowledged everything before `end`, however often it dies meanwhile.
bool Station::send_piece(uplink::Server& server, OneTrial& trial, std::uint64_t end) {
  const trial::Descriptor file(::open(trial.file.c_str(), O_RDONLY | O_CLOEXEC));
  std::uint64_t at = trial.acknowledged;
  for (int attempt = 0; at < end;) {
    core::Bytes piece(end - at);
    if (::pread(file.fd(), piece.data(), piece.size(), off_t(at)) != ssize_t(piece.size()))
      return tally_.failures.emplace_back("a trial's file is gone"), false;
    const uplink::Request request{
        .method = "PATCH",
        .path = fmt::format("/api/v1/uploads/{}?offset_bytes={}", trial.entry.trial_id, at),
        .headers = {{"Content-Type", "application/octet-stream"},
                    {"X-Crc32c", fmt::format("{:08x}", core::crc32c(piece))}},
        .body = piece};
    const auto answer = server.send(request);
    if (!answer || (answer->status != 200 && answer->status != 409)) {
      if (!wait_after(answer ? uplink::error_of(request, *answer) : answer.error(), attempt))
        return false;
      continue;
    }
    const auto json = core::parse_json(core::text_of(answer->body), "answer");
    if (!json || !json->is_object() || !json->contains("offset_bytes"))
      return tally_.failures.emplace_back("an answer without an offset"), false;
    at = (*json)["offset_bytes"].get<std::uint64_t>();
    if (at < trial.acknowledged) tally_.lost_bytes += trial.acknowledged - at;
    if (at > trial.acknowledged) tally_.bytes += at - trial.acknowledged;
    trial.acknowledged = at;
  }
  return true;
}

/// By the station's own code: asks how far the server is, sends what it lacks, commits.
bool Station::commit(uplink::Server& server, OneTrial& trial) {
  const auto first = Clock::now();
  for (int attempt = 0;;) {
    const auto done = uplink::upload_trial(server, trial.file, trial.entry);
    if (trial.entry.offset_bytes < trial.acknowledged && trial.entry.offset_bytes > 0)
      tally_.lost_bytes += trial.acknowledged - trial.entry.offset_bytes;
    if (done) break;
    if (!wait_after(done.error(), attempt)) return false;
  }
  tally_.commits.push_back({first, many_since_s(first), 0.0});
  return true;
}

std::string Station::state_text() const {
  wire::StationStatus told;
  told.state = in_trial_ ? wire::StationState::trial : wire::StationState::idle;
  told.version = "load";
  told.device = "sim-lambda6";
  told.simulated = true;
  if (in_trial_) {
    wire::LiveTrial& trial = told.trial.emplace();
    const std::lock_guard held(mutex_);
    trial.trial_id = trial_id_;
    trial.rig = trial::Rig::palpation;
    trial.case_id = setup_.case_id();
    trial.t_s = many_since_s(trial_begun_);
    trial.samples = static_cast<std::uint64_t>(trial.t_s * options_.rate_Hz);
    trial.force_N = 1.0 + std::sin(trial.t_s);
    trial.depth_m = 0.01;
  }
  return told.to_json().dump();
}

}  // namespace many
}  // namespace tractus
