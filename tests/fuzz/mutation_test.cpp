/// The fuzzers' promises on the same mutations each time, everywhere.
#include <gtest/gtest.h>

#include <random>

#include "target.hpp"

namespace fuzz {

void PrintTo(const Target& target, std::ostream* out) { *out << target.faces; }

namespace {

/// One to four times: a byte changed, a stretch removed, doubled, zeroed, or numbers made extreme.
core::Bytes mutated(core::Bytes bytes, std::mt19937& random) {
  static const std::vector<std::string> kExtremes{"-1",
                                                  "1e999",
                                                  "99999999999999999999",
                                                  "null",
                                                  "\"\"",
                                                  "[]",
                                                  "{}",
                                                  "NaN",
                                                  "\xff\xfe",
                                                  "\n",
                                                  ",",
                                                  "0",
                                                  "../../etc/passwd",
                                                  "%00",
                                                  "[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[["};
  const auto below = [&](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  for (std::size_t turn = 1 + below(4); turn > 0 && !bytes.empty(); --turn) {
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(bytes.size() - at, 200));
    const auto begin = bytes.begin() + std::ptrdiff_t(at), end = begin + std::ptrdiff_t(length);
    switch (below(6)) {
      case 0:
        *begin = std::byte(below(256));
        break;
      case 1:
        bytes.erase(begin, end);
        break;
      case 2: {
        const core::Bytes part(begin, end);
        bytes.insert(end, part.begin(), part.end());
        break;
      }
      case 3:
        std::fill(begin, end, std::byte{});
        break;
      case 4: {
        const auto extreme = core::bytes_of(kExtremes[below(kExtremes.size())]);
        bytes.insert(begin, extreme.begin(), extreme.end());
        break;
      }
      default:
        std::fill(begin, begin + std::ptrdiff_t(std::min<std::size_t>(length, 4)), std::byte{0xff});
    }
  }
  return bytes;
}

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
  const int tries = GetParam().tries;
  int refused = 0;
  for (int i = 0; i < tries; ++i)
    refused += !GetParam().run(mutated(seeds[std::size_t(i) % seeds.size()], random));
  EXPECT_GT(refused, tries / 20) << "nothing is refused";
}

}  // namespace
}  // namespace fuzz
