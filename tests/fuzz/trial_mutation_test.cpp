/// The fuzzer's promises on the same mutations each time.
#include <gtest/gtest.h>

#include <checkout.hpp>
#include <random>

#include "core/file.hpp"
#include "fuzz/mutation.hpp"
#include "fuzz/trial_bytes.hpp"

namespace tractus {
namespace fuzz {
namespace {

core::Bytes golden(const std::string& name) {
  return core::read_file(std::string(checkout::kSource) + "/tests/golden/" + name).value();
}

struct Golden {
  const char *name, *whole, *torn;
  friend void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.name; }
};

/// Of each rig and format.
class TrialMutation : public testing::TestWithParam<Golden> {
 protected:
  core::Bytes small() const { return golden(GetParam().whole); }
  core::Bytes torn() const { return golden(GetParam().torn); }
};
INSTANTIATE_TEST_SUITE_P(Rigs, TrialMutation,
                         testing::Values(Golden{"palpation", "trial-format-2/palpation.trial",
                                                "trial-format-2/palpation-torn.trial"},
                                         Golden{"probing", "trial-format-2/probing.trial",
                                                "trial-format-2/probing-torn.trial"},
                                         Golden{"palpation_one", "trial-format-1/small.trial",
                                                "trial-format-1/torn.trial"},
                                         Golden{"probing_one", "trial-format-1-probing/small.trial",
                                                "trial-format-1-probing/torn.trial"}),
                         [](const auto& rig) { return rig.param.name; });

TEST_P(TrialMutation, TheWholeFilesAreRead) {
  EXPECT_TRUE(try_trial(small()));
  EXPECT_TRUE(try_trial(torn()));
  EXPECT_TRUE(try_trial(repaired(small())));
  EXPECT_EQ(repaired(small()), small());
}

TEST_P(TrialMutation, NoMutationBreaksAPromise) {
  std::mt19937 random(1);
  const auto whole = small();
  for (int i = 0; i < 4000; ++i) try_trial(mutated(whole, random, Texts::none));
}

TEST_P(TrialMutation, NoMutationWithTrueChecksumsBreaksAPromise) {
  std::mt19937 random(2);
  const auto whole = small();
  int read = 0;
  constexpr int kTries = 8000;
  for (int i = 0; i < kTries; ++i) read += try_trial(repaired(mutated(whole, random, Texts::none)));
  EXPECT_GT(read, kTries / 20) << "the repair reaches nothing";
  EXPECT_LT(read, kTries * 19 / 20) << "nothing is refused";
}

}  // namespace
}  // namespace fuzz
}  // namespace tractus
