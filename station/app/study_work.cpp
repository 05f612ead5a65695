#include "station/app/study_work.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "core/try.hpp"
#include "station/app/exchange.hpp"
#include "station/devices/catalogue.hpp"
#include "station/uplink/study.hpp"

namespace tractus {
namespace app {
namespace {
using wire::StudyWork;

constexpr int kAhead = 400;  // all that is left: the server may be away for the rest of the day

/// A person in front of the rig of a simulated participant, or the reverse, would spoil the data.
core::Result<void> check_who(const std::string& device, const StudyWork& work) {
  const bool simulated = devices::is_simulated(device);
  if (simulated == work.simulated) return {};
  return core::Error{core::Errc::bad_input,
                     fmt::format("{} is {}: --device {} would record {} in that name",
                                 work.participant, work.simulated ? "simulated" : "a person",
                                 device, simulated ? "a simulated surgeon" : "a person")};
}

core::Result<StudyPart> part_from_anywhere(const Options& options,
                                           const session::StationFolder& folder,
                                           const std::string& participant) {
  auto server = TRY(connect(options));
  auto work = uplink::take_trials(*server, options.study, participant, kAhead);
  if (work) {
    TRY(session::keep_work(folder, *work));
    return StudyPart{std::move(*work), false};
  }
  if (work.error().code != core::Errc::unavailable) return work.error();
  auto kept = session::kept_work(folder, options.study, participant);
  if (!kept) return kept.error().code == core::Errc::not_found ? work.error() : kept.error();
  std::fputs("the server is away: going on with what is on the disk\n", stderr);
  return StudyPart{std::move(*kept), true};
}

}  // namespace

core::Result<StudyPart> study_part(const Options& options, const session::StationFolder& folder,
                                   const std::string& participant, const std::string& device) {
  auto part = TRY(part_from_anywhere(options, folder, participant));
  TRY(check_who(device, part.work));
  return part;
}

core::Result<wire::AssignedWork> next_of_study(const Options& options,
                                               const session::StationFolder& folder,
                                               const std::string& participant) {
  const auto part = TRY(study_part(options, folder, participant, options.setup.device));
  const auto todo = TRY(session::still_to_do(folder, part.work));
  wire::AssignedWork out{.participant = part.work.participant, .left = todo.size(), .trial = {}};
  if (todo.empty()) return out;
  const wire::SealedTrial& next = todo.front();
  out.trial = wire::AssignedTrial{.slot = next.slot,
                                  .rig = trial::Rig::probing,
                                  .name = fmt::format("Trial {}", next.number),
                                  .assignment = part.work.study,
                                  .number = next.number,
                                  .planned = part.work.planned,
                                  .case_id = "",
                                  .sealed = next.sealed};
  return out;
}

}  // namespace app
}  // namespace tractus
