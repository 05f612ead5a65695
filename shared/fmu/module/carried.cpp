#include <fmt/format.h>

#include <filesystem>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "fmu/module/file_uri.hpp"
#include "fmu/module/simulation.hpp"

namespace tractus {
namespace fmu {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMostTextBytes = 64ull << 20;

/// Empty where there is none.
Result<std::string> text_of_field(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::string();
  const auto bytes = TRY(core::read_file(path, kMostTextBytes));
  return std::string(core::text_of(bytes));
}

}  // namespace

Result<std::unique_ptr<Carried>> read_carried(std::string_view guid_given,
                                              std::string_view resources) {
  const fs::path folder = TRY(path_of(resources));
  const fs::path path = folder / "model.json", field_path = folder / "field.json";
  const auto bytes = TRY(core::read_file(path, kMostTextBytes));
  const std::string text(core::text_of(bytes)), field_text = TRY(text_of_field(field_path));
  if (guid(text + field_text) != guid_given)
    return Error{Errc::corrupt,
                 fmt::format("{}: changed since the export, or of another model than guid {}",
                             path.string(), guid_given.substr(0, 60))};
  const auto json = TRY(core::parse_json(text, path.string()));
  const std::string where = path.string() + ": ";
  if (field_text.empty()) {
    auto model = TRY(models::ProbingModel::from_json(json, where));
    return carried(std::move(model));
  }
  auto model = TRY(models::PalpationModel::from_json(json, where));
  const auto opacities =
      TRY(core::read_file(folder / "opacity.f32", kMostCarriedVoxels * sizeof(float)));
  const auto field = TRY(read_field(field_text, opacities, field_path.string() + ": "));
  return carried(std::move(model), field);
}

}  // namespace fmu
}  // namespace tractus
