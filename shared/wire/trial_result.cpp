#include "wire/trial_result.hpp"

#include "core/try.hpp"

namespace tractus {
namespace wire {
namespace {
constexpr std::size_t kMostScores = 64;
constexpr double kMostValue = 1e12;

core::Result<ResultScore> score_of(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  ResultScore out{.label = fields.text("label", 200),
                  .unit = fields.text("unit", 20),
                  .shown_as = fields.text("shown_as", 40),
                  .value = fields.number("value", -kMostValue, kMostValue)};
  TRY(fields.done());
  return out;
}
}  // namespace

core::Json TrialResult::to_json() const {
  core::Json list = core::Json::array();
  for (const ResultScore& score : scores)
    list.push_back({{"label", score.label},
                    {"unit", score.unit},
                    {"shown_as", score.shown_as},
                    {"value", score.value}});
  return {{"state", core::name(state)},
          {"correct", correct ? core::Json(*correct) : core::Json()},
          {"scores", list}};
}

core::Result<TrialResult> TrialResult::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  TrialResult out;
  out.state = fields.word<ResultState>("state");
  const core::Json* correct = fields.member("correct");
  if (correct && !correct->is_boolean() && !correct->is_null())
    fields.wrong("correct", "true, false or null is expected");
  const core::Json* scores = fields.member("scores");
  if (scores && (!scores->is_array() || scores->size() > kMostScores))
    fields.wrong("scores", "an array of at most 64 is expected");
  TRY(fields.done());
  if (correct->is_boolean()) out.correct = correct->get<bool>();
  for (const core::Json& one : *scores) {
    auto score = TRY(score_of(one, where + "scores: "));
    out.scores.push_back(std::move(score));
  }
  return out;
}

}  // namespace wire
}  // namespace tractus
