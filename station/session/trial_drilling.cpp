#include "station/session/trial_drilling.hpp"

#include <fmt/format.h>

#include "drilling/channel.hpp"

namespace session {
namespace fs = std::filesystem;

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

core::Result<drilling::Worn> put_drilled(const StationFolder& folder, const std::string& trial_id,
                                         const std::string& case_id, volume::Volume& bone) {
  if (!core::is_id(trial_id))
    return core::Error{core::Errc::bad_input,
                       fmt::format("--drilled {}: a trial's id is expected", trial_id)};
  const fs::path file = folder.trial_file(trial_id), state = folder.drilled_file(trial_id);
  std::error_code failure;
  if (fs::exists(file, failure)) {
    auto again = drilling::redrill(file, bone);
    if (!again) return again.error();
    if (again->header.case_id != case_id)
      return core::Error{core::Errc::bad_input,
                         fmt::format("--drilled {}: that trial was of the case {}", trial_id,
                                     again->header.case_id)};
    drilling::drilled_of(again->erosion).put_into(bone);
    return drilling::worn_of(again->erosion);
  }
  if (!fs::exists(state, failure))
    return core::Error{core::Errc::not_found, fmt::format("--drilled {}: neither {} nor {} is here",
                                                          trial_id, file.string(), state.string())};
  auto kept = drilling::read_drilled(state, trial_id, case_id, bone.geometry.dims);
  if (!kept) return kept.error();
  kept->put_into(bone);
  return drilling::Worn{};
}

}  // namespace session
