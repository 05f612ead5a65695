#include "server/api/trials/samples_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <span>

#include "core/file.hpp"
#include "core/try.hpp"
#include "server/api/trials/uploads.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMaxArray_bytes = 512u << 20;
constexpr std::size_t kHead_bytes = 128;  // of any shape: 64 are too few, 128 enough

using PalpationRow = std::array<double, 15>;
using ProbingRow = std::array<double, 8>;

PalpationRow row_of(const trial::Sample& s) {
  const auto& p = s.p_VH_m;
  const auto& q = s.q_VH;
  const auto& f = s.force_N;
  const auto& t = s.torque_Nm;
  return {s.t_s,        p[0],         p[1],         p[2],         q[0],
          q[1],         q[2],         q[3],         double(f[0]), double(f[1]),
          double(f[2]), double(t[0]), double(t[1]), double(t[2]), double(s.flags)};
}

ProbingRow row_of(const trial::ProbingSample& s) {
  return {s.t_s,          s.x_m,           s.theta_rad,
          double(s.fz_N), double(s.tz_Nm), double(s.speed_m_s),
          double(s.mode), double(s.flags)};
}

/// The .npy format 1.0: magic, version, length of the header, a Python literal, padded.
std::string head_of(std::uint64_t rows, std::size_t columns) {
  std::string out("\x93NUMPY\x01\x00", 8);
  constexpr std::size_t kLiteral = kHead_bytes - 10;
  out += static_cast<char>(kLiteral & 255u);
  out += static_cast<char>(kLiteral >> 8);
  out +=
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  out.resize(kHead_bytes - 1, ' ');
  return out + '\n';
}

/// Rows first, then the head, which says how many there are.
class ArrayFile {
 public:
  explicit ArrayFile(const std::filesystem::path& path) : out_(path, std::ios::binary) {
    out_ << std::string(kHead_bytes, ' ');
  }
  void add(std::span<const double> row) {
    static_assert(std::endian::native == std::endian::little);
    columns_ = row.size();
    if (is_full()) return;
    ++rows_;
    out_.write(reinterpret_cast<const char*>(row.data()),
               static_cast<std::streamsize>(row.size() * sizeof(double)));
  }
  bool is_full() const { return rows_ * columns_ * sizeof(double) >= kMaxArray_bytes; }
  bool finish() {
    out_.seekp(0);
    out_ << head_of(rows_, columns_);
    out_.close();
    return !out_.fail();
  }

 private:
  std::ofstream out_;
  std::uint64_t rows_ = 0;
  std::size_t columns_ = std::tuple_size_v<PalpationRow>;
};

}  // namespace

std::uint64_t samples_npy_bytes(std::uint64_t samples) {
  return kHead_bytes +
         std::min(samples * std::tuple_size_v<PalpationRow> * sizeof(double), kMaxArray_bytes);
}

Result<void> write_samples_npy(const std::filesystem::path& trial_file, double rate_Hz,
                               const std::filesystem::path& to) {
  ArrayFile array(to);
  double next_s = 0.0;
  const auto take = [&](const auto& sample) {
    if (rate_Hz > 0.0 && sample.t_s < next_s) return;
    // The next row is the first sample of the next interval: no drift over a long trial.
    if (rate_Hz > 0.0) next_s = (std::floor(sample.t_s * rate_Hz + 1e-9) + 1.0) / rate_Hz;
    array.add(row_of(sample));
  };
  TRY(trial::scan_trial(trial_file, [&](const trial::Block& block) { block.each(take); },
                        {.max_samples = kMaxTrialSamples, .max_bytes = kMaxTrial_bytes}));
  if (array.is_full())
    return Error{Errc::too_large, "the array is larger than 512 MiB: use a lower rate_Hz"};
  if (array.finish()) return {};
  return core::system_error(to, "cannot write");
}

}  // namespace api
}  // namespace tractus
