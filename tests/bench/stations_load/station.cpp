#include "tests/bench/stations_load/station.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <random>

#include "core/file.hpp"
#include "trial/trial_file.hpp"
#include "wire/live.hpp"
#include "wire/messages.hpp"

namespace tractus {
namespace load {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
namespace {

double since_s(Clock::time_point begun) {
  return std::chrono::duration<double>(Clock::now() - begun).count();
}

trial::Header header_of(const std::string& id, const std::string& case_id, double rate_Hz) {
  trial::Header header;
  header.id = id;
  header.case_id = case_id;
  header.station = "load";
  header.operator_name = "simulated hand";
  header.simulated = true;
  header.device = "sim-lambda6";
  header.started_utc_us = 1'770'000'000'000'000;
  header.rate_Hz = rate_Hz;
  header.probe = {{"length_m", 0.13},
                  {"radius_m", 0.0007},
                  {"points", 3},
                  {"point_spacing_m", 0.009},
                  {"pose_offset_m", {0.0, 0.0, 0.0}}};
  return header;
}

/// Smooth motion with a sensor's noise: what the packing meets in earnest.
trial::Sample sample_at(std::uint32_t tick, double rate_Hz, std::mt19937& random) {
  std::normal_distribution<double> noise;
  trial::Sample out;
  out.t_s = tick / rate_Hz;
  const double swing = std::sin(2.0 * M_PI * 0.7 * out.t_s);
  out.p_VH_m = {1e-3 * swing + 2e-6 * noise(random), 2e-6 * noise(random),
                -0.11 + 2e-6 * noise(random)};
  for (std::size_t i = 0; i < 3; ++i) {
    out.force_N[i] = static_cast<float>(1.5 * swing + 0.01 * noise(random));
    out.torque_Nm[i] = static_cast<float>(0.02 * swing + 1e-4 * noise(random));
    out.rendered_force_N[i] = out.force_N[i];
    out.rendered_torque_Nm[i] = out.torque_Nm[i];
  }
  out.tick = tick;
  out.iterations = 3;
  return out;
}

}  // namespace

core::Result<std::string> trial_bytes(const fs::path& folder, const std::string& id,
                                      const std::string& case_id, double rate_Hz, double seconds,
                                      unsigned seed) {
  const fs::path path = folder / (id + ".trial");
  auto writer = trial::TrialWriter::create(path, header_of(id, case_id, rate_Hz));
  if (!writer) return writer.error();
  std::mt19937 random(seed);
  const auto samples = static_cast<std::uint32_t>(seconds * rate_Hz);
  const auto block = static_cast<std::uint32_t>(rate_Hz * 0.02);  // the recorder's 20 ms
  std::vector<trial::Sample> part;
  for (std::uint32_t tick = 0; tick < samples; ++tick) {
    part.push_back(sample_at(tick, rate_Hz, random));
    if (part.size() < block && tick + 1 < samples) continue;
    if (auto done = writer->append(part); !done) return done.error();
    part.clear();
  }
  if (auto done = writer->append(trial::Event{seconds, "end"}); !done) return done.error();
  if (auto done = writer->finish(); !done) return done.error();
  auto bytes = core::read_file(path);
  if (!bytes) return bytes.error();
  fs::remove(path);
  return std::string(core::text_of(*bytes));
}

Station::Station(const Server& server, std::size_t number, std::string id, std::string bytes,
                 double seconds, double between_s)
    : server_(server),
      number_(number),
      id_(std::move(id)),
      bytes_(std::move(bytes)),
      seconds_(seconds),
      between_s_(between_s),
      live_([this](std::stop_token stop) { say_states(stop); }),
      sending_([this] { send_trial(); }) {}

Met Station::finish() {
  sending_.join();
  live_.request_stop();
  live_.join();
  met_.states = states_;
  return met_;
}

void Station::send_trial() {
  auto server =
      uplink::HttpServer::make(server_.url(), server_.token(number_), server_.authority());
  const auto ask = [&](const std::string& method, const std::string& tail, std::string_view body,
                       std::vector<std::pair<std::string, std::string>> headers = {}) {
    const std::string path = "/api/v1/uploads/" + id_ + tail;
    auto answer = (*server)->send({.method = method,
                                   .path = path,
                                   .headers = std::move(headers),
                                   .body = core::bytes_of(body)});
    const bool fine = answer && answer->status == 200;
    if (!fine && met_.failure.empty())
      met_.failure = !answer ? answer.error().what
                             : fmt::format("{} {}: {} {}", method, tail, answer->status,
                                           core::text_of(answer->body));
    return fine;
  };
  const wire::UploadAnnouncement said{server_.case_id(), bytes_.size(),
                                      core::sha256(core::bytes_of(bytes_))};
  if (!server || !ask("PUT", "", said.to_json().dump())) return;
  const auto pieces = static_cast<std::size_t>(std::ceil(seconds_ / between_s_));
  const std::size_t size = bytes_.size() / pieces + 1;
  const auto phase = std::chrono::duration<double>(between_s_ * double(number_ * 37 % 80) / 80.0);
  auto due = Clock::now() + std::chrono::duration_cast<Clock::duration>(phase);
  for (std::size_t at = 0; at < bytes_.size(); at += size) {
    due += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(between_s_));
    std::this_thread::sleep_until(due);
    const std::string_view piece = std::string_view(bytes_).substr(at, size);
    const auto begun = Clock::now();
    if (!ask("PATCH", fmt::format("?offset_bytes={}", at), piece,
             {{"X-Crc32c", fmt::format("{:08x}", core::crc32c(core::bytes_of(piece)))},
              {"Content-Type", "application/octet-stream"}}))
      return;
    met_.acknowledged_s.push_back(since_s(begun));
    met_.bytes += piece.size();
  }
  const auto begun = Clock::now();
  if (ask("POST", "/commit", "")) met_.committed_s = since_s(begun);
}

void Station::say_states(const std::stop_token& stop) {
  const std::atomic<bool> stopped = false;
  const uplink::ServerAddress to{.url = server_.url(),
                                 .headers = {{"Authorization", "Bearer " + server_.token(number_)}},
                                 .authority = server_.authority()};
  auto line = uplink::open_server_socket(to, stopped);
  wire::StationStatus told;
  told.state = wire::StationState::trial;
  told.version = "load";
  told.device = "sim-lambda6";
  told.simulated = true;
  wire::LiveTrial& trial = told.trial.emplace();
  trial.trial_id = id_;
  trial.rig = trial::Rig::palpation;
  trial.case_id = server_.case_id();
  const auto begun = Clock::now();
  for (auto due = begun; line && !stop.stop_requested();) {
    due += std::chrono::milliseconds(50);
    std::this_thread::sleep_until(due);
    trial.t_s = since_s(begun);
    trial.samples = static_cast<std::uint64_t>(trial.t_s * 1000.0);
    trial.force_N = 1.0 + std::sin(trial.t_s);
    trial.depth_m = 0.01;
    if (!(*line)->send(told.to_json().dump()) || !(*line)->receive(1)) return;
    ++states_;
  }
}

}  // namespace load
}  // namespace tractus
