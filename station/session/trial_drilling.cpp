#include "station/session/trial_drilling.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "drilling/channel.hpp"

namespace tractus {
namespace session {
namespace fs = std::filesystem;
namespace {
core::Result<drilling::Redrilled> redrilled(const fs::path& file, const std::string& trial_id,
                                            const std::string& case_id,
                                            const volume::Volume& bone) {
  auto again = drilling::redrill(file, bone);
  // An assigned trial calls its case by a blind name; that it left what it says is as good.
  if (again && again->header.case_id != case_id && again->agrees() != true)
    return core::Error{core::Errc::bad_input,
                       fmt::format("--drilled {}: that trial was of the case {}", trial_id,
                                   again->header.case_id)};
  return again;
}
}  // namespace

core::Json drilled_detail(const loop::Drilling& drilling, const PreparedCase& prepared) {
  core::Json detail = drilling::drilled_of(drilling.erosion()).to_json();
  detail["channel"] = drilling::channel_of(drilling.erosion(), prepared.model.transfer,
                                           prepared.opened.definition.tract)
                          .to_json();
  return detail;
}

core::Result<void> keep_drilled(const StationFolder& folder, const loop::Drilling& drilling,
                                const std::string& trial_id, const std::string& case_id) {
  return drilling::write_drilled(folder.drilled_file(trial_id),
                                 drilling::drilled_of(drilling.erosion()), trial_id, case_id);
}

core::Result<drilling::ErodedShares> put_drilled(const StationFolder& folder,
                                                 const std::string& trial_id,
                                                 const std::string& case_id, volume::Volume& bone) {
  if (!core::is_id(trial_id))
    return core::Error{core::Errc::bad_input,
                       fmt::format("--drilled {}: a trial's id is expected", trial_id)};
  const fs::path file = folder.trial_file(trial_id), state = folder.drilled_file(trial_id);
  std::error_code failure;
  const bool recorded = fs::exists(file, failure), kept = fs::exists(state, failure);
  if (!recorded && !kept)
    return core::Error{core::Errc::not_found, fmt::format("--drilled {}: neither {} nor {} is here",
                                                          trial_id, state.string(), file.string())};
  drilling::ErodedShares worn;
  drilling::Drilled left;
  if (recorded) {
    auto again = redrilled(file, trial_id, case_id, bone);
    if (!again && !kept) return again.error();
    if (again) worn = drilling::worn_of(again->erosion);
    if (again) left = drilling::drilled_of(again->erosion);
  }
  if (kept) {
    auto read = TRY(drilling::read_drilled(state, trial_id, case_id, bone.geometry.dims));
    left = std::move(read);
  }
  left.put_into(bone);
  return worn;
}

}  // namespace session
}  // namespace tractus
