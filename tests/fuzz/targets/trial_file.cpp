#include "fuzz/target.hpp"
#include "fuzz/trial_bytes.hpp"

namespace tractus::fuzz {

Target trial_file() {
  return {"trial_file",
          "tractus-trial/1 and /2, uploaded by stations; also with its checksums made true",
          {"tests/golden/trial-format-1/small.trial", "tests/golden/trial-format-1/torn.trial",
           "tests/golden/trial-format-1-probing/small.trial",
           "tests/golden/trial-format-2/palpation.trial",
           "tests/golden/trial-format-2/palpation-torn.trial",
           "tests/golden/trial-format-2/probing.trial"},
          [](core::ByteView bytes) {
            const bool read = try_trial(bytes);
            return try_trial(repaired({bytes.begin(), bytes.end()})) || read;
          }};
}

}  // namespace tractus::fuzz
