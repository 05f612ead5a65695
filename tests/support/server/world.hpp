/// What tests of the server need: trial files, a small case bundle.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include "cases/case.hpp"
#include "core/bytes.hpp"
#include "core/file.hpp"
#include "trial/trial_file.hpp"

namespace tractus::world {

inline constexpr std::int64_t kStarted_utc_us = 1'770'000'000'000'000;

/// The length of the probe in every trial made here, m.
inline constexpr double kProbe_m = 0.13;

inline trial::Header header_of(const std::string& id, const std::string& case_id) {
  trial::Header header;
  header.id = id;
  header.case_id = case_id;
  header.station = "station-1";
  header.operator_name = "simulated hand, seed 7";
  header.simulated = true;
  header.device = "sim-lambda6";
  header.started_utc_us = kStarted_utc_us;
  header.rate_Hz = 1000.0;
  header.probe = {{"length_m", kProbe_m},
                  {"radius_m", 0.0007},
                  {"points", 3},
                  {"point_spacing_m", 0.009},
                  {"pose_offset_m", {0.0, 0.0, 0.0}}};
  return header;
}

/// Tick n of a probe that stands straight in a tract along +z of V with its tip `kTip_m` deep,
/// pushed by a transverse force along x that grows from 0 to 2 N over a second and again; every
/// 100th tick is late.
inline constexpr double kTip_m = 0.02;
inline trial::Sample sample_at(std::uint32_t tick) {
  trial::Sample sample;
  sample.t_s = tick * 1e-3;
  sample.p_VH_m = {0.0, 0.0, kTip_m - kProbe_m};
  sample.force_N = {static_cast<float>(tick % 1000) * 2e-3F, 0.0F, 0.5F};
  sample.tick = tick;
  sample.flags = tick % 100 == 99 ? std::uint16_t{trial::kLate} : std::uint16_t{0};
  return sample;
}

enum class Ending { sealed, torn };

/// A trial file of so many samples, with an answer "medial" at the end.
inline void write_trial(const std::filesystem::path& path, const trial::Header& header,
                        std::uint32_t samples, Ending ending = Ending::sealed) {
  auto writer = trial::TrialWriter::create(path, header);
  ASSERT_TRUE(writer) << writer.error().what;
  ASSERT_TRUE(writer->append(trial::Event{0.0, "start"}));
  std::vector<trial::Sample> part;
  for (std::uint32_t tick = 0; tick < samples; ++tick) {
    part.push_back(sample_at(tick));
    if (part.size() == 80 || tick + 1 == samples) {
      ASSERT_TRUE(writer->append(part));
      part.clear();
    }
  }
  const double end_s = samples * 1e-3;
  trial::Answer answer;
  answer.breach = true;
  answer.wall = "medial";
  answer.confidence = 0.75;
  ASSERT_TRUE(writer->append(trial::Event{end_s, "answer", answer.to_json()}));
  ASSERT_TRUE(writer->append(trial::Event{end_s, "end"}));
  if (ending == Ending::torn) return;
  ASSERT_TRUE(writer->finish());
}

inline std::string bytes_of(const std::filesystem::path& path) {
  auto bytes = core::read_file(path);
  EXPECT_TRUE(bytes);
  return bytes ? std::string(core::text_of(*bytes)) : std::string();
}

/// The bytes of such a file, made in `folder`.
/// How a probing trial made here ends.
enum class Cut { no, yes };

/// The bytes of a probing trial of so many samples at 1 kHz: 5 mm/s into the bone at 100 N, a
/// breach from 20 to 28 mm, the answer "a breach at 21 mm" (none when it was cut short).
inline std::string probing_bytes(const std::filesystem::path& folder, const std::string& id,
                                 const std::string& case_id, std::uint32_t samples,
                                 Cut cut = Cut::no) {
  const auto path = folder / (id + ".trial");
  trial::Header header = header_of(id, case_id);
  header.rig = trial::Rig::probing;
  header.device = "sim-rig";
  header.probe = {{"travel_m", 0.028}};
  {
    auto writer = trial::TrialWriter::create(path, header);
    EXPECT_TRUE(writer && writer->append(trial::Event{0.0, "start"}));
    std::vector<trial::ProbingSample> part;
    for (std::uint32_t tick = 0; tick < samples; ++tick) {
      trial::ProbingSample sample;
      sample.t_s = tick * 1e-3;
      sample.x_m = 5e-6 * tick;
      sample.theta_rad = 1e-3 * tick;
      sample.speed_m_s = 5e-3F;
      sample.turning_rad_s = 1.0F;
      sample.fz_N = sample.x_m < 0.020 ? 100.0F : 6.0F;
      sample.mode = sample.x_m < 0.020 ? trial::ProbingMode::bone : trial::ProbingMode::breach;
      sample.tick = tick;
      part.push_back(sample);
    }
    EXPECT_TRUE(writer->append(part));
    const double end_s = samples * 1e-3;
    const trial::Answer said{.breach = true, .wall = {}, .confidence = 0.75, .depth_m = 0.021};
    if (cut == Cut::yes) {
      EXPECT_TRUE(writer->append(trial::Event{end_s, "interrupted"}));
    } else {
      EXPECT_TRUE(writer->append(trial::Event{end_s, "answer", said.to_json()}));
      EXPECT_TRUE(writer->append(trial::Event{end_s, "end"}));
    }
    EXPECT_TRUE(writer->finish());
  }
  std::string bytes = bytes_of(path);
  std::filesystem::remove(path);
  return bytes;
}

inline std::string trial_bytes(const std::filesystem::path& folder, const std::string& id,
                               const std::string& case_id, std::uint32_t samples,
                               Ending ending = Ending::sealed,
                               std::int64_t started_utc_us = kStarted_utc_us) {
  const auto path = folder / (id + ".trial");
  trial::Header header = header_of(id, case_id);
  header.started_utc_us = started_utc_us;
  write_trial(path, header, samples, ending);
  std::string bytes = bytes_of(path);
  std::filesystem::remove(path);
  return bytes;
}

/// A case of 40³ voxels of 1 mm: bone of 1000 HU with a tract along +z, open to medial (+x).
/// Returns its id.
inline std::string make_case(const std::filesystem::path& folder) {
  volume::Volume volume;
  volume.geometry.dims = {40, 40, 40};
  volume.geometry.spacing_m = volume::Vec3::Constant(1e-3);
  volume.geometry.origin_m = volume::Vec3(-0.02, -0.02, 0.0);
  volume.intercept = -1024.0;
  volume.counts.assign(volume.geometry.voxel_count(), 2024);
  cases::Case definition;
  definition.title = "Test block";
  definition.source = "made by a test, no patient";
  definition.made_utc_us = kStarted_utc_us;
  definition.tract.length_m = 0.03;
  definition.tract.radius_m = 0.002;
  cases::Truth truth;
  truth.breached = volume::Wall::medial;
  truth.breach_m = volume::Vec3(0.002, 0.0, 0.02);
  truth.breach_depth_m = 0.002;
  truth.wall_thickness_m = 0.001;
  cases::NewCase made{
      .definition = definition, .truth = truth, .volume = volume, .meta = {}, .draw = {}};
  auto opened = cases::write_case(folder, std::move(made), core::KeyPair::generate());
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().what);
  return opened ? opened->id : std::string();
}

}  // namespace tractus::world
