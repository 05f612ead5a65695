#include "metrics/drilled_channel.hpp"

namespace tractus::metrics {

bool drills(const trial::Trial& trial) { return trial.header.extra.contains("drilling"); }

const core::Json* drilled_detail(const Subject& subject) {
  const core::Json* found = nullptr;
  for (const trial::Event& event : subject.trial.events)
    if (event.is(trial::EventKind::drilled) && event.detail.is_object()) found = &event.detail;
  return found;
}

Score channel_score(const Subject& subject, const char* key) {
  const core::Json* detail = drilled_detail(subject);
  if (!detail) return {{}, kCutShort};
  const auto channel = detail->find("channel");
  if (channel == detail->end() || !channel->is_object())
    return {{}, "the station did not measure the channel"};
  const auto value = channel->find(key);
  if (value == channel->end() || !value->is_number())
    return {{}, "the channel is too short, or there is none"};
  return {value->get<double>(), ""};
}

}  // namespace tractus::metrics
