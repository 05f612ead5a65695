/// A model of either rig: the file's "rig" says which.
#include "core/try.hpp"
#include "models/probing_model.hpp"

namespace tractus {
namespace models {

using core::Json;
using core::Result;

Result<Model> model_from_json(const Json& json, const std::string& where) {
  const bool probing = json.is_object() && json.contains("rig") && json["rig"] == "probing";
  if (probing) {
    auto model = TRY(ProbingModel::from_json(json, where));
    return Model(std::move(model));
  }
  auto model = TRY(PalpationModel::from_json(json, where));
  return Model(std::move(model));
}

Result<Model> read_model(const std::filesystem::path& path) {
  auto json = TRY(core::read_json(path));
  return model_from_json(json, path.string() + ": ");
}

}  // namespace models
}  // namespace tractus
