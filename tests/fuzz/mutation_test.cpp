/// The fuzzers' promises on the same mutations each time, everywhere.
#include "mutation.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "target.hpp"

namespace tractus {
namespace fuzz {

void PrintTo(const Target& target, std::ostream* out) { *out << target.faces; }

namespace {

class Parser : public testing::TestWithParam<Target> {};
INSTANTIATE_TEST_SUITE_P(Every, Parser, testing::ValuesIn(all()),
                         [](const auto& target) { return target.param.name; });

TEST_P(Parser, TakesWhatIsRightAndKeepsItsPromisesOnWhatIsNot) {
  const auto seeds = seeds_of(GetParam());
  ASSERT_FALSE(seeds.empty()) << "put files into tests/fuzz/corpora/" << GetParam().name;
  int right = 0;
  for (const auto& seed : seeds) right += GetParam().run(seed);
  EXPECT_GT(right, 0) << "no seed is taken: mutations of them reach nothing";
  std::mt19937 random(1);
  const char* const more = std::getenv("TRACTUS_MUTATIONS");
  const int tries = more ? std::atoi(more) : GetParam().tries;
  int refused = 0;
  for (int i = 0; i < tries; ++i)
    refused += !GetParam().run(mutated(seeds[std::size_t(i) % seeds.size()], random, Texts::too));
  EXPECT_GT(refused, tries / 20) << "nothing is refused";
}

}  // namespace
}  // namespace fuzz
}  // namespace tractus
