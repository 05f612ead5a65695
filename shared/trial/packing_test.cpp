#include "trial/packing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "trial/frames.hpp"

namespace tractus {
namespace trial {
namespace {
using testing::HasSubstr;

template <class S>
std::vector<S> noise(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::vector<S> out(count);
  auto* bytes = reinterpret_cast<unsigned char*>(out.data());
  for (std::size_t i = 0; i < count * sizeof(S); ++i)
    bytes[i] = static_cast<unsigned char>(random());
  return out;
}

template <class S>
bool same(const std::vector<S>& a, const std::vector<S>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(S)) == 0;
}

template <class S>
class Packing : public testing::Test {};
using Rigs = testing::Types<Sample, ProbingSample>;
TYPED_TEST_SUITE(Packing, Rigs);

TYPED_TEST(Packing, GivesBackAnyBitsAtAll) {
  Packer packer;
  std::vector<TypeParam> back;
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{80},
                                  max_packed_samples(sizeof(TypeParam))}) {
    const auto given = noise<TypeParam>(count, unsigned(count));
    const auto packed = packer.pack(std::span(given));
    EXPECT_LE(packed.size(), kMaxPayload_bytes);
    ASSERT_TRUE(packer.unpack(core::Bytes(packed.begin(), packed.end()), back));
    EXPECT_TRUE(same(back, given)) << count;
  }
}

TYPED_TEST(Packing, ABlockBeginsWithThoseBefore) {
  Packer writer, reader;
  std::vector<TypeParam> back;
  for (const std::size_t count :
       {std::size_t{3}, std::size_t{1}, std::size_t{1}, std::size_t{20}}) {
    const auto given = noise<TypeParam>(count, unsigned(count) + 7);
    const auto packed = writer.pack(std::span(given));
    ASSERT_TRUE(reader.unpack(core::Bytes(packed.begin(), packed.end()), back));
    EXPECT_TRUE(same(back, given)) << count;
    writer.follow(std::span(given));
    reader.follow(std::span<const TypeParam>(back));
  }
}

TYPED_TEST(Packing, RefusesACountThatIsNotThatOfTheContent) {
  Packer packer;
  std::vector<TypeParam> back;
  const auto given = noise<TypeParam>(5, 1);
  const auto view = packer.pack(std::span(given));
  core::Bytes packed(view.begin(), view.end());
  for (const std::uint32_t lie : {0u, 4u, 6u, 1'000'000'000u}) {
    std::memcpy(packed.data(), &lie, sizeof lie);
    const auto refused = packer.unpack(packed, back);
    ASSERT_FALSE(refused) << lie;
    EXPECT_EQ(refused.error().code, core::Errc::corrupt);
    EXPECT_THAT(refused.error().what, HasSubstr(std::to_string(lie) + " packed samples said"));
  }
  EXPECT_FALSE(packer.unpack({}, back));
  EXPECT_FALSE(packer.unpack(core::ByteView(packed).first(4), back));
}

// A hand at rest to within a sensor's noise, 20 ms of it. 1/2.2 is what shared/doc says of motion.
TEST(Packing, AShortBlockOfSmoothMotionTakesLessThanHalf) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  std::vector<Sample> given(80);
  for (std::uint32_t i = 0; i < given.size(); ++i) {
    Sample& s = given[i];
    const double t = i / 4000.0;
    s.t_s = t + 1e-6 * std::abs(noise(random));
    s.p_VH_m = {0.1 + 0.01 * std::sin(9 * t), 0.2 + 0.01 * std::cos(7 * t), 0.3 - 0.05 * t};
    s.q_VH = {std::cos(t), std::sin(t) * 0.6, std::sin(t) * 0.8, 0.0};
    s.force_N = {float(std::sin(20 * t)), float(std::cos(20 * t)), float(1 + 5 * t)};
    s.rendered_force_N = s.force_N;
    s.tick = i;
  }
  Packer packer;
  EXPECT_LT(packer.pack(std::span<const Sample>(given)).size(), given.size() * sizeof(Sample) / 2);
}

}  // namespace
}  // namespace trial
}  // namespace tractus
