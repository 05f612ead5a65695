/// `safety_fuzz [COUNT [FIRST_SEED]]`: half as many probing scenarios and half as many palpation
/// models, each with a wild hand, through the station's own loops. Exit 1 at the first that breaks
/// a promise.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/safety_scenarios.hpp"

namespace tractus {
namespace {
struct Tally {
  const char* what;
  unsigned long long ran = 0, made = 0, moved = 0, at_limit = 0;
  double highest = 0.0;

  bool take(const fuzz::Outcome& out, unsigned long long seed) {
    ++ran;
    made += out.made;
    moved += out.moved;
    at_limit += out.highest > 0.999;
    highest = std::max(highest, out.highest);
    if (out.broken.empty()) return true;
    std::fprintf(stderr, "%s, seed %llu: %s\n", what, seed, out.broken.c_str());
    return false;
  }
  void print() const {
    std::printf(
        "%-10s %llu drawn, %llu valid, %llu felt, %llu reached the limit; highest %.9f of it\n",
        what, ran, made, moved, at_limit, highest);
  }
};
}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  const auto count = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1'000'000ull;
  const auto first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1ull;
  const fuzz::Palpation palpation;
  Tally scenarios{"scenarios"}, models{"models"};
  for (auto seed = first; seed < first + count / 2; ++seed)
    if (!scenarios.take(fuzz::run_probing(seed), seed) || !models.take(palpation.run(seed), seed))
      return 1;
  scenarios.print();
  models.print();
  return 0;
}
