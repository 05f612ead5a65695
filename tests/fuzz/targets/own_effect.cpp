#include "lab/io/own_effect.hpp"

#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto json = core::parse_json(core::text_of(bytes), "it");
  if (!taken(json)) return false;
  const std::vector<lab_io::OwnEffect> own{{*json, "it: "}};
  const bool probing = taken(lab_io::ids_of(own, "probing"));
  return taken(lab_io::ids_of(own, "palpation")) || probing;
}
}  // namespace

Target own_effect() {
  return {"own_effect", "tractus-effect/1 with a formula of a person's own", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
