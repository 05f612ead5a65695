#include "tests/bench/stations_load/many/watch.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "tests/bench/support/report.hpp"

namespace tractus {
namespace many {
namespace fs = std::filesystem;
namespace {

std::vector<pid_t> with_children(pid_t root) {
  std::vector<pid_t> out{root};
  std::ifstream file(fmt::format("/proc/{0}/task/{0}/children", root));
  for (pid_t child = 0; file >> child;) out.push_back(child);
  return out;
}

/// Its share of the memory that it has in common with others; the whole where that is not told.
double proportional_bytes(pid_t pid) {
  std::ifstream file(fmt::format("/proc/{}/smaps_rollup", pid));
  std::string word;
  double kB = 0.0;
  while (file >> word)
    if (word == "Pss:" && file >> kB) return kB * 1024.0;
  return load::resident_bytes(pid);
}

int entries(pid_t pid, const char* folder) {
  std::error_code failure;
  int out = 0;
  for (auto it = fs::directory_iterator(fmt::format("/proc/{}/{}", pid, folder), failure);
       !failure && it != fs::directory_iterator(); it.increment(failure))
    ++out;
  return out;
}

double machine_busy_s() {
  std::ifstream file("/proc/stat");
  std::string word;
  file >> word;
  double busy = 0.0, value = 0.0;
  for (int i = 0; i < 8 && file >> value; ++i)
    if (i != 3 && i != 4) busy += value;  // not idle, not waiting for a disk
  return busy / double(::sysconf(_SC_CLK_TCK));
}

}  // namespace

Watch::Watch(const Setup& setup) : setup_(setup) {
  restart();
  thread_ = std::thread([this] {
    for (int i = 0;; ++i) {
      {
        const std::lock_guard held(mutex_);
        if (stop_) return;
      }
      if (i % 10 == 0) look();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  });
}

Watch::~Watch() {
  {
    const std::lock_guard held(mutex_);
    stop_ = true;
  }
  thread_.join();
}

void Watch::look_at(const std::string& name, pid_t root, bool children) {
  if (root <= 0) return;
  Group& group = groups_[name];
  double bytes = 0.0;
  for (const pid_t pid : children ? with_children(root) : std::vector<pid_t>{root}) {
    const double now_s = load::processor_s(pid);
    const auto [before, fresh] = group.seen_s.try_emplace(pid, now_s);
    group.used.processor_s += std::max(0.0, now_s - before->second);
    before->second = std::max(before->second, now_s);
    bytes += children ? proportional_bytes(pid) : load::resident_bytes(pid);
    if (children || load::first_line(fmt::format("/proc/{}/comm", pid)) != "tractus-server")
      continue;
    group.used.most_descriptors = std::max(group.used.most_descriptors, entries(pid, "fd"));
    group.used.most_threads = std::max(group.used.most_threads, entries(pid, "task"));
  }
  group.used.last_bytes = bytes;
  group.used.most_bytes = std::max(group.used.most_bytes, bytes);
}

void Watch::look() {
  const std::lock_guard held(mutex_);
  for (std::size_t i = 0; i < setup_.servers(); ++i)
    look_at(fmt::format("server {}", i + 1), setup_.server_pid(i), false);
  look_at("PostgreSQL", setup_.database_pid(), true);
  look_at("nginx", setup_.proxy_pid(), true);
}

void Watch::restart() {
  look();
  const std::lock_guard held(mutex_);
  for (auto& [_, group] : groups_) group.used = {};
  machine_s_ = machine_busy_s();
  begun_s_ = bench::wall_s();
}

std::map<std::string, Used> Watch::used() {
  look();
  const std::lock_guard held(mutex_);
  std::map<std::string, Used> out;
  for (const auto& [name, group] : groups_) out[name] = group.used;
  return out;
}

double Watch::machine_cores() {
  return (machine_busy_s() - machine_s_) / (bench::wall_s() - begun_s_);
}

}  // namespace many
}  // namespace tractus
