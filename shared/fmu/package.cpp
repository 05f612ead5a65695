#include "fmu/package.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "effects/expression.hpp"
#include "fmu/description.hpp"
#include "fmu/probing.hpp"
#include "lab/io/zip_file.hpp"

namespace tractus {
namespace fmu {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMostBytes = 1ull << 30;

/// @param carried  names in the zip with contents
Result<void> write_zip(const Description& description,
                       const std::vector<std::pair<std::string, std::string>>& carried,
                       const Target& target) {
  TRY(core::may_be_written(target.out));
  const auto scratch = TRY(core::ScratchFolder::make(target.out));
  const fs::path made = scratch.path() / "made.fmu";
  lab_io::ZipFile zip(made, kMostBytes);
  TRY(zip.add("modelDescription.xml", description_xml(description)));
  TRY(zip.add(fmt::format("binaries/linux64/{}.so", kModelIdentifier), target.runtime));
  for (const auto& [name, content] : carried) TRY(zip.add(name, content));
  TRY(zip.add("documentation/licenses/license.txt", target.runtime.parent_path() / "licences.txt"));
  TRY(zip.finish());
  const auto bytes = TRY(core::read_file(made, kMostBytes));
  return core::write_file(target.out, bytes);
}

}  // namespace

bool has_formula(std::span<const effects::EffectInstance> effects) {
  return std::ranges::any_of(effects,
                             [](const auto& use) { return effects::is_expression(use.id); });
}

Result<fs::path> runtime_path(std::span<const effects::EffectInstance> effects) {
  std::error_code failure;
  const auto own = fs::read_symlink("/proc/self/exe", failure);
  const auto path =
      own.parent_path().parent_path() / "lib/tractus" /
      fmt::format("{}{}.so", kModelIdentifier, has_formula(effects) ? "_formulas" : "");
  if (failure || !fs::exists(path, failure))
    return Error{Errc::not_found,
                 fmt::format("{}: not found; it is installed with this program", path.string())};
  return path;
}

Result<void> write_fmu(const models::ProbingModel& model, const Target& target) {
  const std::string carried = carried_text(model);
  const auto all = variables(model);
  return write_zip(
      {model.name,
       "Force and torque of a probe in bone from its motion: a model of Tractus. Not a "
       "medical device",
       all, guid(carried), target.version},
      {{"resources/model.json", carried}}, target);
}

Result<void> write_fmu(const models::PalpationModel& model, const CarriedField& field,
                       const Target& target) {
  const std::string carried = carried_text(model), about_field = field_text(field);
  const auto all = variables(model, field.down);
  std::vector<double> starts;
  for (const Variable& v : all) starts.push_back(v.start);
  TRY(with_parameters(model, all, starts));
  return write_zip({model.name,
                    "Force and torque of bone on a palpated probe from the motion of its handle: a "
                    "model of Tractus. Not a medical device",
                    all, guid(carried + about_field), target.version},
                   {{"resources/model.json", carried},
                    {"resources/field.json", about_field},
                    {"resources/opacity.f32", std::string(core::text_of(opacity_bytes(field)))}},
                   target);
}

}  // namespace fmu
}  // namespace tractus
