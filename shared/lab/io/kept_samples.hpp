/// What a comparison looked at, kept in one file: a page then asks for any trial at any zoom.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "lab/report/report.hpp"

namespace tractus::lab_io {

/// The bytes of a file that holds both sides (`after` may be null). Long recordings are thinned to
/// some 10⁶ samples together. Little endian:
///
///     "TLS1"  u64 bytes of the header  header (JSON)  then per side, per trial:
///     t_s f64[n]  per channel: measured f32[n], simulated f32[n]  region i8[n] (−1: in none)
std::string kept_samples(const lab::Side& before, const lab::Side* after);

struct Envelope {
  std::vector<double> least, most;
};
/// A channel of a trial over a stretch of time, least and most of the samples behind each point.
struct SampleView {
  double duration_s = 0.0;
  std::vector<double> t_s;
  Envelope measured, simulated, residual;
  double noise_floor = 0.0;
  std::uint64_t samples_per_point = 1;
  /// By region of that side's "where": from and to, seconds.
  std::vector<std::vector<std::pair<double, double>>> regions;
};

struct SampleQuery {
  std::string trial, channel;
  bool after = false;
  double from_s = 0.0, to_s = 0.0;
  std::size_t points = 1000;
};

/// Reads of the file what is asked for and no more. Errors: not_found naming a trial, channel or
/// side that is not there; corrupt; those of the system.
core::Result<SampleView> view_samples(const std::filesystem::path& file, const SampleQuery& wish);

}  // namespace tractus::lab_io
