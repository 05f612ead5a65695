#include "fmu/package.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.hpp"
#include "core/try.hpp"
#include "effects/expression.hpp"
#include "fmu/description.hpp"
#include "lab/io/zip_file.hpp"

namespace tractus {
namespace fmu {
namespace {

namespace fs = std::filesystem;
using core::Errc;
using core::Error;
using core::Result;

constexpr std::uint64_t kMostBytes = 1ull << 30;

}  // namespace

bool has_formula(const models::ProbingModel& model) {
  return std::ranges::any_of(model.effects,
                             [](const auto& use) { return effects::is_expression(use.id); });
}

Result<fs::path> runtime_path(const models::ProbingModel& model) {
  std::error_code failure;
  const auto own = fs::read_symlink("/proc/self/exe", failure);
  const auto path = own.parent_path().parent_path() / "lib/tractus" /
                    fmt::format("{}{}.so", kModelIdentifier, has_formula(model) ? "_formulas" : "");
  if (failure || !fs::exists(path, failure))
    return Error{Errc::not_found,
                 fmt::format("{}: not found; it is installed with this program", path.string())};
  return path;
}

Result<void> write_fmu(const models::ProbingModel& model, const fs::path& runtime,
                       const fs::path& out, std::string_view version) {
  TRY(core::may_be_written(out));
  const std::string carried = carried_text(model);
  const auto scratch = TRY(core::ScratchFolder::make(out));
  const fs::path made = scratch.path() / "made.fmu";
  lab_io::ZipFile zip(made, kMostBytes);
  TRY(zip.add("modelDescription.xml",
              description_xml(model, variables(model), guid(carried), version)));
  TRY(zip.add(fmt::format("binaries/linux64/{}.so", kModelIdentifier), runtime));
  TRY(zip.add("resources/model.json", carried));
  TRY(zip.add("documentation/licenses/license.txt", runtime.parent_path() / "licences.txt"));
  TRY(zip.finish());
  const auto bytes = TRY(core::read_file(made, kMostBytes));
  return core::write_file(out, bytes);
}

}  // namespace fmu
}  // namespace tractus
