/// Recorded trials packed in a recorder's frames of 20 ms, against zstd on the plain samples.
///   bench_trial_packing FILE.ttrial… [--json FILE]
#include <fmt/format.h>
#include <zstd.h>

#include <cstring>

#include "bench/support/report.hpp"
#include "trial/packing.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace {

constexpr double kFrame_s = 0.02;
constexpr int kRepeats = 7;

/// Samples a second of one core, as bytes of plain samples, and how many times smaller.
struct Figures {
  double packing_MB_s = 0.0, unpacking_MB_s = 0.0, ratio = 0.0;
};

template <class S>
std::vector<std::span<const S>> frames_of(const std::vector<S>& samples, double rate_Hz) {
  const auto size = static_cast<std::size_t>(kFrame_s * rate_Hz);
  std::vector<std::span<const S>> out;
  for (std::size_t at = 0; at < samples.size(); at += size)
    out.push_back(std::span(samples).subspan(at, std::min(size, samples.size() - at)));
  return out;
}

template <class S>
Figures ours(const std::vector<S>& samples, double rate_Hz, bool& same) {
  trial::Packer packer;
  const auto frames = frames_of(samples, rate_Hz);
  std::vector<core::Bytes> packed(frames.size());
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto payload = packer.pack(frames[i]);
    packed[i].assign(payload.begin(), payload.end());
    packer.follow(frames[i]);
    bytes += payload.size();
  }
  const double raw = double(samples.size() * sizeof(S));
  const double in = bench::seconds(kRepeats, bench::thread_s, [&] {
    for (const auto& frame : frames) {
      packer.pack(frame);
      packer.follow(frame);
    }
  });
  std::vector<S> back;
  trial::Packer reader;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    same = same && reader.unpack(packed[i], back) &&
           std::memcmp(back.data(), frames[i].data(), frames[i].size_bytes()) == 0;
    reader.follow(std::span<const S>(back));
  }
  const double out = bench::seconds(kRepeats, bench::thread_s, [&] {
    for (const auto& payload : packed) {
      if (!reader.unpack(payload, back)) return;
      reader.follow(std::span<const S>(back));
    }
  });
  return {raw / in * 1e-6, raw / out * 1e-6, raw / double(bytes)};
}

/// zstd on the samples as they lie in memory.
template <class S>
Figures plain(const std::vector<S>& samples, double rate_Hz, int level) {
  const auto frames = frames_of(samples, rate_Hz);
  core::Bytes room(ZSTD_compressBound(frames.front().size_bytes()));
  ZSTD_CCtx* context = ZSTD_createCCtx();
  std::size_t bytes = 0;
  const double s = bench::seconds(kRepeats, bench::thread_s, [&] {
    bytes = 0;
    for (const auto& frame : frames)
      bytes += ZSTD_compressCCtx(context, room.data(), room.size(), frame.data(),
                                 frame.size_bytes(), level);
  });
  ZSTD_freeCCtx(context);
  const double raw = double(samples.size() * sizeof(S));
  return {raw / s * 1e-6, 0.0, raw / double(bytes)};
}

template <class S>
void judge(bench::Report& report, const std::string& name, const std::vector<S>& samples,
           double rate_Hz) {
  bool same = true;
  const Figures us = ours(samples, rate_Hz, same);
  report.must(name + ", every bit back", same);
  report.at_least(name + ", times smaller", us.ratio, 2.2, "");
  report.at_least(name + ", packing", us.packing_MB_s, 500, "MB/s");
  report.at_least(name + ", unpacking", us.unpacking_MB_s, 500, "MB/s");
  for (const int level : {1, 3}) {
    const Figures zstd = plain(samples, rate_Hz, level);
    report.row(fmt::format("{}, zstd -{} alone, times smaller", name, level), zstd.ratio, "");
    report.row(fmt::format("{}, zstd -{} alone", name, level), zstd.packing_MB_s, "MB/s");
  }
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("trial_packing");
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--json"; ++i) {
    const auto trial = trial::read_trial(argv[i]);
    if (!trial) {
      fmt::print(stderr, "{}\n", trial.error().what);
      return 2;
    }
    const std::string name = fmt::format("{} {}", trial->header.device, i);
    if (!trial->samples.empty()) judge(report, name, trial->samples, trial->header.rate_Hz);
    if (!trial->probing.empty()) judge(report, name, trial->probing, trial->header.rate_Hz);
  }
  return report.finish(argc, argv);
}
