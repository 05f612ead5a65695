#include "station/uplink/study.hpp"

#include <fmt/format.h>

#include "core/try.hpp"

namespace tractus::uplink {

core::Result<wire::StudyWork> take_trials(Server& server, const std::string& study,
                                          const std::string& participant, int ahead) {
  for (const std::string& name : {study, participant})
    if (!wire::is_study_name(name))
      return core::Error{
          core::Errc::bad_input,
          fmt::format("{}: letters, digits, - and _ are expected", name.substr(0, 64))};
  const Request request{.method = "POST",
                        .path = fmt::format("/api/v1/studies/{}/participants/{}/take?ahead={}",
                                            study, participant, ahead),
                        .max_answer_bytes = 16u << 20};
  auto answer = TRY(server.send(request));
  auto json = TRY(json_of(request, answer));
  auto work = wire::StudyWork::from_json(json, "the server's trials: ");
  if (!work) return work.error();
  if (work->study != study || work->participant != participant)
    return core::Error{core::Errc::bad_input, "the server's trials are somebody else's"};
  return work;
}

}  // namespace tractus::uplink
