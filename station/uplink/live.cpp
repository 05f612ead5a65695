#include "station/uplink/live.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <random>

namespace tractus {
namespace uplink {
namespace {
using Clock = std::chrono::steady_clock;
constexpr int kPoliteness = 10;  // of nice(2)
}  // namespace

int wait_before_ms(int attempt, double chance) {
  const int doubled = LiveUplink::kFirstWait_ms << std::clamp(attempt, 0, 10);
  const int most = std::min(doubled, LiveUplink::kLongestWait_ms);
  return static_cast<int>(most * (0.75 + 0.25 * chance));
}

LiveUplink::LiveUplink(Parts parts) : parts_(std::move(parts)), thread_([this] { run(); }) {}

LiveUplink::~LiveUplink() {
  stop_ = true;
  thread_.join();
}

void LiveUplink::pause(int ms) const {
  constexpr int kStep_ms = 50;
  for (int waited = 0; waited < ms && !stop_; waited += kStep_ms)
    std::this_thread::sleep_for(std::chrono::milliseconds(std::min(kStep_ms, ms - waited)));
}

void LiveUplink::run() {
  static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kPoliteness));
  std::mt19937 random(std::random_device{}());
  std::uniform_real_distribution<double> chance;
  for (int attempt = 0; !stop_; ++attempt) {
    if (auto line = parts_.open(stop_); line) {
      const auto begun = Clock::now();
      if (parts_.connected) parts_.connected();
      connected_ = true;
      hold(**line);
      connected_ = false;
      if (Clock::now() - begun > std::chrono::seconds(10)) attempt = 0;
    }
    if (!stop_) pause(wait_before_ms(attempt, chance(random)));
  }
}

void LiveUplink::hold(ServerSocket& line) {
  std::string said;
  Clock::time_point when;
  while (!stop_) {
    const std::string now = parts_.told().to_json().dump();
    if (now != said || Clock::now() - when > std::chrono::milliseconds(kAlive_ms)) {
      if (!line.send(now)) return;
      said = now;
      when = Clock::now();
    }
    const auto next = Clock::now() + std::chrono::milliseconds(kBetween_ms);
    while (!stop_ && Clock::now() < next) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next - Clock::now());
      auto heard = line.receive(std::max(1, static_cast<int>(left.count())));
      if (!heard) return;
      if (!*heard) continue;
      const auto json = core::parse_json(**heard, "command");
      if (!json) continue;  // of a newer server: not for us
      if (const auto command = wire::StationCommand::from_json(*json, "command"))
        parts_.commanded(*command);
    }
  }
  // Whoever stopped this station waits to see that it did: long enough for a wall to be told.
  if (const std::string last = parts_.told().to_json().dump(); last != said && line.send(last))
    std::this_thread::sleep_for(std::chrono::milliseconds(3 * kBetween_ms));
}

}  // namespace uplink
}  // namespace tractus
