/// libFuzzer: any bytes as a trial file, as they are and with their checksums repaired.
#include "trial_bytes.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  fuzz::try_trial(bytes);
  fuzz::try_trial(fuzz::repaired({bytes.begin(), bytes.end()}));
  return 0;
}
