/// A zip that is made while it is sent, through the server's transport to curl: SIMULATED trials,
/// against cp of the same bytes, and a sparse zip of any size; how much memory the server takes.
///   bench_export [--gib N] [--trials N] [--folder DIR] [--json FILE]
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "bench/support/report.hpp"
#include "server/api/stored_zip.hpp"
#include "server/api/trials/samples_array.hpp"
#include "server/http/server.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;

constexpr std::uint64_t kLargestArray_bytes = 128 + 3'600'000 * 15 * 8;  // 15 minutes at 4 kHz
constexpr std::uint32_t kTrialSamples = 960'000;                         // 4 minutes at 4 kHz
constexpr double kMostMemory_MB = 200.0;

/// Zeros.
class Sparse : public api::EntryContent {
 public:
  explicit Sparse(std::uint64_t size) : left_(size) {}
  core::Result<void> append_to(std::string& out) override {
    const auto some = std::min<std::uint64_t>(left_, 256 << 10);
    out.append(some, '\0');
    left_ -= some;
    return {};
  }

 private:
  std::uint64_t left_;
};

class Rows : public api::EntryContent {
 public:
  explicit Rows(api::SampleRows rows) : rows_(std::move(rows)) {}
  core::Result<void> append_to(std::string& out) override {
    const auto more = rows_.append_to(out);
    if (!more) return more.error();
    return {};
  }

 private:
  api::SampleRows rows_;
};

struct Served {
  std::shared_ptr<api::StoredZip> zip;
  api::OpenEntry open;
};

Served sparse_zip(std::uint64_t size) {
  std::vector<api::StoredEntry> entries;
  for (std::uint64_t come = 0; come < size; come += kLargestArray_bytes)
    entries.push_back({fmt::format("samples/{:06}.npy", entries.size()), kLargestArray_bytes});
  return {
      std::make_shared<api::StoredZip>(std::move(entries)),
      [](std::size_t) -> core::Result<std::unique_ptr<api::EntryContent>> {
        return std::unique_ptr<api::EntryContent>(std::make_unique<Sparse>(kLargestArray_bytes));
      }};
}

/// A hand of noise: smooth strokes with the sensor's last digits, as recorded trials have them.
void write_trial(const fs::path& path) {
  trial::Header header;
  header.id = std::string(32, 'a');
  header.case_id = std::string(64, 'c');
  header.station = "bench";
  header.simulated = true;
  header.device = "simulated";
  header.started_utc_us = 1;
  header.rate_Hz = 4000.0;
  auto writer = trial::TrialWriter::create(path, header);
  core::require(bool(writer), "the folder takes a file");
  std::vector<trial::Sample> block;
  std::uint32_t noise = 1;
  const auto digit = [&] { return double(noise = noise * 1664525 + 1013904223) * 1e-16; };
  for (std::uint32_t i = 0; i < kTrialSamples; ++i) {
    trial::Sample s;
    s.t_s = i / 4000.0;
    s.p_VH_m = {0.01 * std::sin(3.0 * s.t_s) + digit(), 0.01 * std::cos(2.0 * s.t_s) + digit(),
                -0.1 + digit()};
    s.force_N = {float(std::sin(5.0 * s.t_s)), float(digit()), 0.5F};
    s.tick = i;
    block.push_back(s);
    if (block.size() < 80) continue;
    core::require(bool(writer->append(std::span<const trial::Sample>(block))), "the disk has room");
    block.clear();
  }
  core::require(bool(writer->finish()), "the disk has room");
}

Served trials_zip(const fs::path& folder, int trials) {
  std::vector<api::StoredEntry> entries;
  for (int i = 0; i < trials; ++i) {
    write_trial(folder / fmt::format("{}.ttrial", i));
    entries.push_back({fmt::format("samples/{}.raw", i), std::uint64_t{kTrialSamples} * 15 * 8});
  }
  return {std::make_shared<api::StoredZip>(std::move(entries)),
          [folder](std::size_t i) -> core::Result<std::unique_ptr<api::EntryContent>> {
            auto rows = api::SampleRows::open(folder / fmt::format("{}.ttrial", i), 0.0);
            if (!rows) return rows.error();
            return std::unique_ptr<api::EntryContent>(std::make_unique<Rows>(std::move(*rows)));
          }};
}

struct Child {
  pid_t pid;
  int port;
};

/// A process that serves the zip until it is killed.
Child serve(const Served& served) {
  int ends[2];
  core::require(::pipe(ends) == 0, "a pipe can be made");
  const pid_t pid = ::fork();
  if (pid == 0) {
    http::Service service;
    service.handle = [&served](const http::Request& request) {
      http::Response response;
      const auto part = http::wanted_part(request, served.zip->size(), "", response);
      if (part)
        response.body = http::MadeBody{std::make_shared<api::StoredZipSource>(
                                           served.zip, served.open, part->first, part->second),
                                       part->second};
      return response;
    };
    http::ServerOptions options;
    options.port = 0;
    auto server = http::Server::open(options, std::move(service));
    core::require(bool(server), "a port is free");
    const int port = server->port();
    core::require(::write(ends[1], &port, sizeof port) == sizeof port, "the parent reads");
    server->run();
    ::_exit(0);
  }
  Child out{pid, 0};
  core::require(::read(ends[0], &out.port, sizeof out.port) == sizeof out.port, "it serves");
  return out;
}

double peak_memory_MB(pid_t pid) {
  std::ifstream in(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1024e-6;
  return 0.0;
}

/// Downloads to the file and judges it; returns MB/s.
double download(bench::Report& report, const std::string& name, const Served& served,
                const fs::path& to) {
  const Child child = serve(served);
  const double start = bench::wall_s();
  std::FILE* said = ::popen(fmt::format("curl -s -o {} -w '%{{size_download}}' "
                                        "http://127.0.0.1:{}/cohort.zip",
                                        to.string(), child.port)
                                .c_str(),
                            "r");
  unsigned long long come = 0;
  const bool read = std::fscanf(said, "%llu", &come) == 1;
  const bool whole = ::pclose(said) == 0 && read && come == served.zip->size();
  const double MB_s = double(come) / (bench::wall_s() - start) * 1e-6;
  report.must(name + ", every byte came", whole);
  report.row(name + ", size", double(come) * 1e-9, "GB");
  report.row(name, MB_s, "MB/s");
  report.at_most(name + ", peak memory of the server", peak_memory_MB(child.pid), kMostMemory_MB,
                 "MB");
  ::kill(child.pid, SIGKILL);
  ::waitpid(child.pid, nullptr, 0);
  return MB_s;
}

double copy_MB_s(const fs::path& from, const fs::path& to) {
  const double start = bench::wall_s();
  core::require(std::system(("cp " + from.string() + " " + to.string()).c_str()) == 0, "cp runs");
  return double(fs::file_size(from)) / (bench::wall_s() - start) * 1e-6;
}

void trials(bench::Report& report, const fs::path& folder, int count) {
  const Served served = trials_zip(folder, count);
  const fs::path zip = folder / "cohort.zip";
  const double ours = download(report, "simulated trials", served, zip);
  report.must("simulated trials, unzip -t",
              std::system(("unzip -tqq " + zip.string()).c_str()) == 0);
  const double copied = copy_MB_s(zip, folder / "copy.zip");
  report.row("cp of the same bytes", copied, "MB/s");
  report.row("share of cp", ours / copied, "");
}

}  // namespace
}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  const auto option = [&](std::string_view name, std::string fallback) {
    for (int i = 1; i + 1 < argc; ++i)
      if (argv[i] == name) fallback = argv[i + 1];
    return fallback;
  };
  const std::filesystem::path folder =
      std::filesystem::path(option("--folder", "/tmp")) / fmt::format("bench-export-{}", getpid());
  std::filesystem::create_directories(folder);
  bench::Report report("export");
  trials(report, folder, std::stoi(option("--trials", "8")));
  download(report, "sparse", sparse_zip(std::stoull(option("--gib", "10")) << 30), "/dev/null");
  std::filesystem::remove_all(folder);
  return report.finish(argc, argv);
}
