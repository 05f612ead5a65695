#include "station/session/study_plan.hpp"

#include <fmt/format.h>

#include <set>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace session {
namespace fs = std::filesystem;
namespace {
fs::path file_of(const StationFolder& folder, const std::string& study,
                 const std::string& participant) {
  return folder.studies() / study / (participant + ".json");
}
}  // namespace

core::Result<void> keep_work(const StationFolder& folder, const wire::StudyWork& work) {
  const fs::path path = file_of(folder, work.study, work.participant);
  std::error_code failure;
  fs::create_directories(path.parent_path(), failure);
  if (failure)
    return core::Error{core::Errc::io, fmt::format("{}: cannot make the folder: {}",
                                                   path.parent_path().string(), failure.message())};
  return core::write_json(path, work.to_json());
}

core::Result<wire::StudyWork> kept_work(const StationFolder& folder, const std::string& study,
                                        const std::string& participant) {
  const fs::path path = file_of(folder, study, participant);
  auto json = TRY(core::read_json(path));
  return wire::StudyWork::from_json(json, path.string() + ": ");
}

core::Result<std::vector<wire::SealedTrial>> still_to_do(const StationFolder& folder,
                                                         const wire::StudyWork& work) {
  auto entries = TRY(folder.outbox().entries());
  std::set<std::string> spent;
  for (const auto& entry : entries) spent.insert(entry.case_id);
  std::vector<wire::SealedTrial> out;
  for (const wire::SealedTrial& trial : work.trials)
    if (!spent.contains(trial.slot)) out.push_back(trial);
  return out;
}

}  // namespace session
}  // namespace tractus
