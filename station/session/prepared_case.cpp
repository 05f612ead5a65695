#include "station/session/prepared_case.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "station/session/trial_drilling.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace session {
namespace fs = std::filesystem;
namespace {
core::Progress part_of(const core::Progress& whole, double from, double to) {
  if (!whole) return {};
  return [&whole, from, to](double share) { return whole(from + share * (to - from)); };
}

core::Result<void> check_signer(const StationFolder& folder, const cases::OpenedCase& opened) {
  const auto& trusted = folder.trusted();
  if (std::ranges::find(trusted, opened.signer_public_hex) != trusted.end()) return {};
  return core::Error{
      core::Errc::forbidden,
      fmt::format("{}: signed by {}, whom this station does not trust (tractus-station trust)",
                  opened.folder.string(), opened.signer_public_hex)};
}

core::Result<models::PalpationModel> model_for(const cases::OpenedCase& opened,
                                               const fs::path& model_file) {
  if (model_file.empty()) return opened.definition.model;
  return models::PalpationModel::read(model_file);
}
}  // namespace

core::Result<fs::path> find_case(const StationFolder& folder, const std::string& which) {
  std::error_code failure;
  if (fs::exists(fs::path(which) / "case.json", failure)) return fs::path(which);
  if (which.size() < 8 || which.find_first_not_of("0123456789abcdef") != std::string::npos)
    return core::Error{
        core::Errc::not_found,
        fmt::format("--case {}: neither a case's folder nor eight or more characters of an id",
                    which)};
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder.cases(), failure))
    if (entry.path().filename().string().starts_with(which)) found.push_back(entry.path());
  if (found.size() == 1) return found.front();
  return core::Error{
      core::Errc::not_found,
      fmt::format("--case {}: {} in {}", which,
                  found.empty() ? "no such case" : "several such cases", folder.cases().string())};
}

core::Result<std::unique_ptr<PreparedCase>> prepare_case(const StationFolder& folder,
                                                         const std::string& which,
                                                         const fs::path& model_file,
                                                         const core::Progress& progress,
                                                         const std::string& drilled) {
  auto path = TRY(find_case(folder, which));
  auto opened = TRY(cases::open_case(path));
  TRY(check_signer(folder, opened));
  auto model = TRY(model_for(opened, model_file));
  auto file = TRY(volume::VolumeFile::open(opened.folder / "volume.tvol"));
  auto voxels = TRY(file.read_all(part_of(progress, 0.0, 0.5)));
  drilling::ErodedShares worn;
  if (!drilled.empty()) {
    auto put = TRY(put_drilled(folder, drilled, opened.id, voxels));
    worn = std::move(put);
  }
  auto runtime = TRY(models::PalpationRuntime::make(model, voxels, part_of(progress, 0.5, 1.0)));
  if (progress) progress(1.0);
  return std::unique_ptr<PreparedCase>(new PreparedCase{std::move(opened), std::move(model),
                                                        std::move(voxels), std::move(runtime),
                                                        drilled, std::move(worn)});
}

}  // namespace session
}  // namespace tractus
