/// The header of the store format: JSON that says everything about a volume but its voxels.
#pragma once

#include <array>
#include <string>

#include "core/result.hpp"
#include "volume/volume_file.hpp"

namespace tractus::volume {

inline constexpr std::string_view kVolumeMagic = "TRACTVOL";
inline constexpr std::uint32_t kVolumeVersion = 1;
inline constexpr std::size_t kPreambleBytes = 16;           ///< magic, version, header length
inline constexpr std::size_t kHeaderLimitBytes = 1u << 20;  ///< of the JSON
inline constexpr std::size_t kIndexEntryBytes = 36;         ///< length u32, SHA-256

struct VolumeHeader {
  Geometry geometry;
  double slope = 1.0;
  double intercept = 0.0;
  std::array<double, 2> value_range{};
  Histogram histogram;
  VolumeMeta meta;
};

/// One line of JSON: the same header always gives the same bytes.
std::string header_text(const VolumeHeader& header);
/// Errors: corrupt or bad_input, led by `where`: a field missing, unknown, or contradicting
/// another.
core::Result<VolumeHeader> parse_header(std::string_view text, const std::string& where);
/// What no reader would take. Errors: bad_input, led by `where`.
core::Result<void> check_header(const VolumeHeader& header, const std::string& where);

}  // namespace tractus::volume
