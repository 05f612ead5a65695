/// A trial as curves for people: channels over time with level of detail, the tip's path thinned,
/// and, of a probing trial, force against depth.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trial/trial.hpp"

namespace tractus::trial {

/// The part of the header's `probe` that places the tip.
struct ProbeShape {
  double length_m = 0.0;  ///< handle's origin to the unbent tip, along z of H
  math::Vec3 pose_offset_m = math::Vec3::Zero();  ///< added to the recorded position, in V
};
/// Nothing when the header does not give a length in (0, 1] m, or its offset is not three finite
/// numbers.
std::optional<ProbeShape> probe_shape(const Header& header);
/// Tip of the bent probe in V: p_VH + offset + q_VH (δx, δy, L).
math::Vec3 tip_m(const Sample& sample, const ProbeShape& probe);

/// The tract's axis as trial sees it: a line from the mouth into the bone, in V.
struct TractLine {
  math::Vec3 entry_m = math::Vec3::Zero();
  math::Vec3 axis = math::Vec3::UnitZ();  ///< unit vector
};

/// Of palpation. Forces and torques are those of the model, what the bone does to the probe, in H:
/// xy transverse (magnitude), z along the shank (signed). depth_m: of the tip along the tract's
/// axis. offset_m: the tip's distance from that axis. angle_rad: between the unbent shank and that
/// axis. The last three need probe and tract.
inline constexpr std::array<std::string_view, 7> kChannels{
    "force_xy_N", "force_z_N", "torque_xy_Nm", "torque_z_Nm", "depth_m", "offset_m", "angle_rad"};

/// Of probing. force_N and torque_Nm: of the hand on the probe. depth_m, speed_m_s, angle_rad: of
/// the probe. mode: ProbingMode as a number. round_trip_s: of the exchange over the bus.
inline constexpr std::array<std::string_view, 7> kProbingChannels{
    "force_N", "depth_m", "speed_m_s", "angle_rad", "torque_Nm", "mode", "round_trip_s"};

/// Smallest and largest of the samples behind each point.
struct Envelope {
  std::vector<float> min, max;
};

struct View {
  std::size_t samples_per_point = 1;  ///< 1: every sample is shown, min equals max
  double from_s = 0.0,
         to_s = 0.0;        ///< times of the first and the last sample shown; 0 when there is none
  std::vector<double> t_s;  ///< middle of each point's samples
  std::vector<std::pair<std::string, Envelope>> channels;  ///< in the order asked for
};

struct Path {
  std::vector<double> t_s;
  std::vector<math::Vec3> tip_m;  ///< of the bent probe, in V
  std::vector<float> force_N;     ///< magnitude of the model's force
};

/// Force against depth, in order of time.
struct DepthCurve {
  std::vector<double> t_s;
  std::vector<float> depth_m, force_N;
  std::vector<ProbingMode> mode;
};

/// Fed with samples in order (by scan_trial, frame by frame, or all at once), asked as often as one
/// likes. Holds kBytesPerSample. A question reads the range once: 10⁶ samples, all channels, take
/// some milliseconds.
class Signals {
 public:
  Signals(const Header& header, std::optional<TractLine> tract);
  /// Of the header's rig.
  void add(const Block& block);

  static constexpr std::size_t kBytesPerSample = 52;
  std::size_t size() const { return t_s_.size(); }
  Rig rig() const { return rig_; }
  /// The channels of this trial that have all they need.
  std::vector<std::string> channels() const;
  /// Is this a channel, and is all there that it needs?
  bool has(std::string_view channel) const;
  /// The channels asked for within [from_s, to_s] in at most `points` points (≥ 1) of equally many
  /// samples. Errors: bad_input for a channel that has() denies, naming it; a range that is not a
  /// range; no points.
  core::Result<View> view(std::span<const std::string> channels, double from_s, double to_s,
                          std::size_t points) const;
  /// At most `points` (≥ 1) samples of the path, one of each of as many equal stretches of time:
  /// that of the largest force, so that no contact is lost. Empty without a probe.
  Path path(std::size_t points) const;
  /// At most `points` (≥ 2) samples: of as many equal stretches as there are pairs the one of the
  /// least and the one of the greatest force, in their order. Empty for palpation.
  DepthCurve force_against_depth(std::size_t points) const;

 private:
  void add(const Sample& sample);
  void add(const ProbingSample& sample);
  std::optional<std::size_t> index_of(std::string_view channel) const;
  Rig rig_;
  std::optional<ProbeShape> probe_;
  std::optional<TractLine> tract_;
  std::vector<double> t_s_;
  std::array<std::vector<float>, kChannels.size()> values_;
  std::vector<std::array<float, 3>> tip_m_;
  std::vector<float> force_N_;
};

}  // namespace tractus::trial
