/// libFuzzer over one target: TRACTUS_FUZZ_TARGET=NAME tractus_fuzz [libFuzzer's options] CORPUS
#include <cstdio>
#include <cstdlib>

#include "target.hpp"

namespace tractus {
namespace {
const fuzz::Target* chosen() {
  static const auto targets = fuzz::all();
  const char* name = std::getenv("TRACTUS_FUZZ_TARGET");
  for (const auto& target : targets)
    if (name && target.name == name) return &target;
  std::fprintf(stderr, "TRACTUS_FUZZ_TARGET is one of");
  for (const auto& target : targets) std::fprintf(stderr, " %s", target.name.c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}
}  // namespace
}  // namespace tractus

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tractus;
  static const fuzz::Target& target = *chosen();
  target.run(std::as_bytes(std::span(data, size)));
  return 0;
}
