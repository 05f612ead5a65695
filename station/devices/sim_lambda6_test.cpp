/// The simulated lambda.6 against bone of its own: an elastic tube, so that nothing of the model
/// under test is used.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "station/devices/catalogue.hpp"

namespace tractus {
namespace devices {
namespace {
using math::Vec3;
constexpr core::Instant_ns kPeriod = 250'000;

DeviceOptions options_of(std::uint64_t seed) {
  DeviceOptions options;
  options.seed = seed;
  options.duration_s = 20.0;
  options.channel.entry_m = {-0.13, 0.0, 0.0};
  return options;
}

MadeDevice made(const DeviceOptions& options) {
  auto device = find("sim-lambda6")->make(options);
  EXPECT_TRUE(device);
  return std::move(*device);
}

/// An elastic tube of bone round the channel: 60 N/m against the straight tip beyond the radius (a
/// bending shank), 3000 N/m beyond the end; a hole gives nothing.
struct Tube {
  KnownTract channel;
  std::string hole;

  math::Wrench push_on(const math::Pose& X_DH, double probe_m) const {
    const Vec3 tip = X_DH * Vec3(0, 0, probe_m) - channel.entry_m;
    const double depth = tip.dot(channel.axis);
    math::Wrench out;
    if (depth < 0.0) return out;
    if (depth > channel.length_m && hole != "anterior")
      out.force_N -= 3000.0 * (depth - channel.length_m) * channel.axis;
    const Vec3 radial = tip - depth * channel.axis;
    const double beyond = radial.norm() - channel.radius_m;
    const bool through = hole == "lateral" && depth > 0.4 * channel.length_m &&
                         depth < 0.6 * channel.length_m &&
                         radial.normalized().dot(-channel.medial) > 0.7;
    if (beyond > 0.0 && !through) out.force_N -= 60.0 * beyond * radial.normalized();
    out.torque_Nm = (X_DH.q * Vec3(0, 0, probe_m)).cross(out.force_N);
    return out;
  }
};

struct Palpation {
  std::vector<Sample> samples;
  SimulatedAnswer answer;
  double deepest_m = -1.0;
  double hardest_N = 0.0;
};

Palpation palpate(std::uint64_t seed, const std::string& hole) {
  const DeviceOptions options = options_of(seed);
  const MadeDevice sim = made(options);
  EXPECT_TRUE(sim.device->open());
  const Tube tube{options.channel, hole};
  Palpation out;
  for (core::Instant_ns now = 0; !sim.trainee->done() && now < 100'000'000'000; now += kPeriod) {
    Sample sample;
    EXPECT_EQ(sim.device->read(now, sample), Status::ok);
    const auto push = tube.push_on(sample.X_DH, options.probe_length_m);
    EXPECT_EQ(sim.device->write(push), Status::ok);
    const Vec3 tip = sample.X_DH * Vec3(0, 0, options.probe_length_m);
    out.deepest_m =
        std::max(out.deepest_m, (tip - options.channel.entry_m).dot(options.channel.axis));
    out.hardest_N = std::max(out.hardest_N, push.force_N.norm());
    out.samples.push_back(sample);
  }
  sim.device->close();
  out.answer = sim.trainee->answer();
  return out;
}

TEST(SimLambda6, StartsThirtyMillimetresBeforeTheMouth) {
  const auto start = palpate(1, "").samples.front();
  EXPECT_NEAR((start.X_DH * Vec3(0, 0, 0.13) - Vec3(-0.13, 0, 0)).norm(), 0.030,
              0.002);  // the plan's, and tremor
}

TEST(SimLambda6, ReachesTheEndOfTheChannelAndIsStoppedThere) {
  const Palpation whole = palpate(1, "");
  EXPECT_GT(whole.deepest_m, 0.0399);
  EXPECT_LT(
      whole.deepest_m,
      0.0412);  // the hand aims 3 mm beyond: 350 N/m against 3000 N/m leaves 0.3 mm, and tremor
  EXPECT_GT(whole.hardest_N, 0.3);
}

TEST(SimLambda6, GoesThroughAnEndThatIsNotThere) {
  EXPECT_GT(palpate(1, "anterior").deepest_m, 0.0425);
}

TEST(SimLambda6, RepeatsTheSameBitsForTheSameSeed) {
  const auto a = palpate(5, ""), b = palpate(5, "");
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    ASSERT_EQ(a.samples[i].X_DH.p, b.samples[i].X_DH.p) << "tick " << i;
    ASSERT_EQ(a.samples[i].X_DH.q.coeffs(), b.samples[i].X_DH.q.coeffs()) << "tick " << i;
  }
}

TEST(SimLambda6, MovesOtherwiseForAnotherSeed) {
  EXPECT_GT((palpate(5, "").samples[20000].X_DH.p - palpate(6, "").samples[20000].X_DH.p).norm(),
            1e-5);
}

TEST(SimLambda6, TellsAWholeChannelFromOneThatIsBrokenWhereItIsBroken) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    EXPECT_FALSE(palpate(seed, "").answer.breach) << "seed " << seed;
    EXPECT_EQ(palpate(seed, "lateral").answer.wall, "lateral") << "seed " << seed;
    EXPECT_EQ(palpate(seed, "anterior").answer.wall, "anterior") << "seed " << seed;
  }
}

TEST(SimLambda6, TremblesBetweenEightAndTwelveHertz) {
  // Power of the handle's transverse motion at rest, by the discrete Fourier sum at each whole
  // frequency.
  const auto samples = palpate(3, "").samples;
  const std::size_t n = 1200;  // 0.3 s of the first rest: 3.33 Hz per bin
  const auto power = [&](double hertz) {
    std::complex<double> sum = 0.0;
    double mean = 0.0;
    for (std::size_t i = 0; i < n; ++i) mean += samples[i].X_DH.p.y() / double(n);
    for (std::size_t i = 0; i < n; ++i)
      sum += (samples[i].X_DH.p.y() - mean) *
             std::polar(1.0, -2.0 * std::numbers::pi * hertz * double(i) / 4000.0);
    return std::norm(sum);
  };
  EXPECT_GT(power(10.0), 10.0 * power(20.0));
  EXPECT_GT(power(10.0), 10.0 * power(30.0));
}

TEST(SimLambda6, FallsUnderAConstantPushWithTheHandsStiffness) {
  // 2 N across, held: the hand's 350 N/m gives way by 5.71 mm (Hooke).
  const DeviceOptions options = options_of(1);
  const MadeDevice pushed = made(options), free = made(options);
  ASSERT_TRUE(pushed.device->open());
  ASSERT_TRUE(free.device->open());
  Sample a, b;
  for (core::Instant_ns now = 0; now < 400'000'000; now += kPeriod) {
    EXPECT_EQ(pushed.device->read(now, a), Status::ok);
    EXPECT_EQ(free.device->read(now, b), Status::ok);
    EXPECT_EQ(pushed.device->write({{0, 2.0, 0}, Vec3::Zero()}), Status::ok);
  }
  EXPECT_NEAR((a.X_DH.p - b.X_DH.p).y(), 2.0 / 350.0, 2e-5);
}

TEST(SimLambda6, GivesNoMoreThanTwentyNewtonsAndSaysSo) {
  const MadeDevice sim = made(options_of(1));
  ASSERT_TRUE(sim.device->open());
  Sample sample;
  EXPECT_EQ(sim.device->read(0, sample), Status::ok);
  EXPECT_EQ(sim.device->write({{0, 500.0, 0}, Vec3::Zero()}), Status::ok);
  EXPECT_EQ(sim.device->read(kPeriod, sample), Status::ok);
  EXPECT_TRUE(sample.saturated);
  // 20 N on 0.2 kg for one tick of 0.25 ms: at most 25 mm/s more (Newton), not 625.
  EXPECT_LT(sample.velocity_m_s.norm(), 0.03);
}

}  // namespace
}  // namespace devices
}  // namespace tractus
