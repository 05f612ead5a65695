#include "capture/recipe.hpp"
#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto recipe = capture::Recipe::read(placed("recipe/assembly.json", bytes));
  if (!taken(recipe)) return false;
  core::require(!recipe->recordings.empty(), "a recipe has recordings");
  for (const auto& one : recipe->recordings)
    core::require(one.motion.is_relative() && one.force.is_relative(), "paths stay in the folder");
  return true;
}
}  // namespace

Target assembly_recipe() {
  return {"assembly_recipe", "tractus-assembly/1, from a person", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
