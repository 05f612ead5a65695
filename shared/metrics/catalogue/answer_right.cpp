#include "metrics/metric.hpp"

namespace tractus {
namespace metrics {
namespace {
Score judged_probing(const trial::Answer& answer, int walls) {
  if (answer.breach == (walls > 0)) return {1.0, ""};
  return {0.0, walls > 0 ? "a breach was missed" : "a breach was felt where there is none"};
}

Score judged(const Subject& subject) {
  const auto answer = subject.trial.answer();
  if (!answer) return {{}, "no answer was given"};
  if (!subject.truth) return {{}, "the truth is not known here"};
  if (subject.trial.header.rig == trial::Rig::probing)
    return judged_probing(*answer, subject.truth->walls);
  const auto& breached = subject.truth->breached;
  if (answer->breach != breached.has_value())
    return {0.0, breached ? "a breach was missed" : "a breach was seen where there is none"};
  if (breached && answer->wall != volume::name(*breached))
    return {0.0, answer->wall ? "the breach is in another wall" : "no wall was named"};
  return {1.0, ""};
}
}  // namespace

MetricInfo answer_right() {
  MetricInfo info{
      "answer_right",
      "Answer correct",
      "1",
      "1 if the last answer says whether there is a breach and, in palpation if there is, in "
      "which wall; else 0.",
      "own definition",
      kBothRigs,
      judged};
  info.shown_as = ShownAs::correct_or_incorrect;
  return info;
}

}  // namespace metrics
}  // namespace tractus
