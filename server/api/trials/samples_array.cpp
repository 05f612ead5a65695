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

std::size_t row_bytes(trial::Rig rig) {
  return rig == trial::Rig::palpation ? sizeof(PalpationRow) : sizeof(ProbingRow);
}

/// Appends the samples that are the rows of the rate.
template <class Sample>
void append_rows(std::span<const Sample> samples, double rate_Hz, double& next_s,
                 std::string& out) {
  static_assert(std::endian::native == std::endian::little);
  for (const Sample& sample : samples) {
    if (rate_Hz > 0.0 && sample.t_s < next_s) continue;
    // The next row is the first sample of the next interval: no drift over a long trial.
    if (rate_Hz > 0.0) next_s = (std::floor(sample.t_s * rate_Hz + 1e-9) + 1.0) / rate_Hz;
    const auto row = row_of(sample);
    out.append(reinterpret_cast<const char*>(row.data()), sizeof row);
  }
}

}  // namespace

std::uint64_t samples_npy_bytes(std::uint64_t samples) {
  return kHead_bytes +
         std::min(samples * std::tuple_size_v<PalpationRow> * sizeof(double), kMaxArray_bytes);
}

std::uint64_t npy_rows(trial::Rig rig, std::uint64_t size_bytes) {
  return size_bytes / row_bytes(rig);
}

std::uint64_t npy_bytes(trial::Rig rig, std::uint64_t rows) {
  return kHead_bytes + rows * row_bytes(rig);
}

std::string npy_head(trial::Rig rig, std::uint64_t rows) {
  std::string out("\x93NUMPY\x01\x00", 8);
  constexpr std::size_t kLiteral = kHead_bytes - 10;
  out += static_cast<char>(kLiteral & 255u);
  out += static_cast<char>(kLiteral >> 8);
  const trial::Rig of = rows == 0 ? trial::Rig::palpation : rig;
  out += fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows,
                     row_bytes(of) / sizeof(double));
  out.resize(kHead_bytes - 1, ' ');
  return out + '\n';
}

Result<SampleRows> SampleRows::open(const std::filesystem::path& trial_file, double rate_Hz) {
  auto reader = TRY(trial::TrialReader::open(
      trial_file, {.max_samples = kMaxTrialSamples, .max_bytes = kMaxTrial_bytes}));
  return SampleRows(std::move(reader), rate_Hz);
}

Result<bool> SampleRows::append_to(std::string& out) {
  const auto block = TRY(reader_.next());
  if (!block) return false;
  if (!block->probing.empty()) rig_ = trial::Rig::probing;
  append_rows(block->palpation, rate_Hz_, next_s_, out);
  append_rows(block->probing, rate_Hz_, next_s_, out);
  return true;
}

/// Rows first, then the head, which says how many there are.
Result<void> write_samples_npy(const std::filesystem::path& trial_file, double rate_Hz,
                               const std::filesystem::path& to) {
  auto rows = TRY(SampleRows::open(trial_file, rate_Hz));
  std::ofstream out(to, std::ios::binary);
  out << std::string(kHead_bytes, ' ');
  std::uint64_t size = 0;
  std::string piece;
  for (bool more = true; more; piece.clear()) {
    more = TRY(rows.append_to(piece));
    size += piece.size();
    if (size >= kMaxArray_bytes)
      return Error{Errc::too_large, "the array is larger than 512 MiB: use a lower rate_Hz"};
    out << piece;
  }
  out.seekp(0);
  out << npy_head(rows.rig(), npy_rows(rows.rig(), size));
  out.close();
  if (out) return {};
  return core::system_error(to, "cannot write");
}

}  // namespace api
}  // namespace tractus
