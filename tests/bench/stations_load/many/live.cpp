#include "tests/bench/stations_load/many/live.hpp"

#include <random>

#include "station/uplink/live.hpp"
#include "station/uplink/server_socket.hpp"

namespace tractus {
namespace many {
namespace {

constexpr std::size_t kThreads = 8;

/// One station's connection, as LiveUplink holds it, without a thread of its own.
struct Line {
  const Station* station = nullptr;
  uplink::ServerAddress to;
  std::unique_ptr<uplink::ServerSocket> socket;
  Clock::time_point next, opened;
  int attempt = 0;
  bool was_open = false;
};

}  // namespace

LiveLines::LiveLines(const Setup& setup, const Options& options,
                     const std::vector<std::unique_ptr<Station>>& stations)
    : setup_(setup), options_(options), stations_(stations) {
  for (std::size_t i = 0; i < kThreads; ++i) threads_.emplace_back([this, i] { run(i); });
}

LiveLines::~LiveLines() {
  stop_ = true;
  for (std::thread& thread : threads_) thread.join();
}

void LiveLines::note(const std::string& why) {
  const std::lock_guard held(mutex_);
  ++refused_[why.substr(0, 100)];
}

std::map<std::string, int> LiveLines::refused() const {
  const std::lock_guard held(mutex_);
  return refused_;
}

void LiveLines::run(std::size_t first) {
  std::mt19937 random(static_cast<unsigned>(first));
  std::uniform_real_distribution<double> chance;
  const auto in_trial = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1.0 / options_.states_Hz));
  std::vector<Line> lines;
  for (std::size_t i = first; i < stations_.size(); i += kThreads) {
    Line& line = lines.emplace_back();
    line.station = stations_[i].get();
    line.to = {.url = setup_.url(),
               .headers = {{"Authorization", "Bearer " + setup_.token(i)}},
               .authority = setup_.authority()};
    line.next = Clock::now() + std::chrono::milliseconds(int(5000.0 * chance(random)));
  }
  const auto failed = [&](Line& line) {
    if (line.socket) --open_;
    line.socket.reset();
    if (Clock::now() - line.opened > std::chrono::seconds(10)) line.attempt = 0;
    line.next = Clock::now() +
                std::chrono::milliseconds(uplink::wait_before_ms(line.attempt++, chance(random)));
  };
  while (!stop_) {
    for (Line& line : lines) {
      if (stop_ || Clock::now() < line.next) continue;
      if (!line.socket) {
        auto made = uplink::open_server_socket(line.to, stop_);
        if (!made) {
          note(made.error().what);
          failed(line);
          continue;
        }
        line.socket = std::move(*made);
        line.opened = Clock::now();
        if (line.was_open) ++reconnects_;
        line.was_open = true;
        ++open_;
      }
      line.next = Clock::now() + (line.station->in_trial()
                                      ? in_trial
                                      : std::chrono::milliseconds(uplink::LiveUplink::kAlive_ms));
      if (!line.socket->send(line.station->state_text()) || !line.socket->receive(0))
        failed(line);
      else
        ++states_;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace many
}  // namespace tractus
