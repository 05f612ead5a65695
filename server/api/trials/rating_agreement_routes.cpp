/// How far those who rated the same trials agree, over the trials that the caller may see.
#include <algorithm>
#include <cmath>
#include <map>

#include "assessment/rating_agreement.hpp"
#include "core/try.hpp"
#include "db/store/trials/trials.hpp"
#include "server/api/backend.hpp"
#include "server/api/trials/rating_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;
using statistics::Matrix;

constexpr double kMostVersions = 1e6;

/// A trial's ratings by all of its raters, each the last that was given without seeing another's.
struct RatedTrial {
  std::vector<std::string> raters;       ///< by name
  std::vector<std::vector<int>> scores;  ///< [rater][item]
  bool simulated = false;
};

Result<RatedTrial> rated_trial(store::Reading& tx, const store::RatingRequest& request) {
  const auto trial = TRY(store::trial_of(tx, request.trial_id));
  RatedTrial out{.raters = {}, .scores = {}, .simulated = trial->summary.simulated};
  const auto ratings = TRY(store::ratings_of(tx, request.trial_id));
  std::string rater_id;
  for (const store::Rating& one : ratings) {
    if (one.rubric_id != request.rubric_id || !one.independent) continue;
    if (one.rater_id != rater_id) out.raters.push_back(one.rater), out.scores.emplace_back();
    rater_id = one.rater_id;
    out.scores.back() = one.scores;
  }
  return out;
}

Result<std::vector<RatedTrial>> rated_trials(store::Reading& tx, const Call& call) {
  const auto requests = TRY(store::rating_requests(tx, ""));
  std::vector<RatedTrial> out;
  for (const store::RatingRequest& request : requests) {
    const bool asked = request.rubric_id == call.text("rubric") &&
                       request.version == call.integer("version") && request.complete() &&
                       request.raters > 1;
    if (!asked) continue;
    const auto sees = TRY(sees_trial(tx, call, request.trial_id));
    if (!sees) continue;
    auto rated = TRY(rated_trial(tx, request));
    out.push_back(std::move(rated));
  }
  return out;
}

using RatedTogether = std::vector<const RatedTrial*>;

/// [trial][rater] of an item.
Matrix item_scores(const RatedTogether& trials, std::size_t item) {
  Matrix out(std::ssize(trials), std::ssize(trials.front()->raters));
  for (std::size_t t = 0; t < trials.size(); ++t)
    for (std::size_t r = 0; r < trials[t]->raters.size(); ++r)
      out(Eigen::Index(t), Eigen::Index(r)) = trials[t]->scores[r][item];
  return out;
}

Matrix total_scores(const RatedTogether& trials, std::size_t items) {
  Matrix out = item_scores(trials, 0);
  for (std::size_t item = 1; item < items; ++item) out += item_scores(trials, item);
  return out;
}

Json finite_json(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? Json(*value) : Json();
}

Json agreement_json(const assessment::RatingAgreement& of) {
  const auto end = [](const std::optional<double>& there, double value) {
    return finite_json(there ? std::optional(value) : std::nullopt);
  };
  return {{"single", finite_json(of.single)},
          {"single_low", end(of.single, of.single_95.low)},
          {"single_high", end(of.single, of.single_95.high)},
          {"mean", finite_json(of.mean)},
          {"mean_low", end(of.mean, of.mean_95.low)},
          {"mean_high", end(of.mean, of.mean_95.high)},
          {"kappa", finite_json(of.kappa)},
          {"note", of.note}};
}

Json totals_json(const Matrix& totals) {
  Json out = Json::array();
  for (Eigen::Index trial = 0; trial < totals.rows(); ++trial) {
    Json row = Json::array();
    for (Eigen::Index rater = 0; rater < totals.cols(); ++rater)
      row.push_back(totals(trial, rater));
    out.push_back(std::move(row));
  }
  return out;
}

Json group_json(const RatedTogether& trials, const assessment::Rubric& rubric) {
  const Matrix totals = total_scores(trials, rubric.items.size());
  Json items = Json::array();
  for (std::size_t i = 0; i < rubric.items.size(); ++i) {
    const auto& item = rubric.items[i];
    Json one = agreement_json(assessment::rating_agreement(
        item_scores(trials, i), assessment::ScoreScale{item.low, item.high}));
    one["label"] = item.label;
    items.push_back(std::move(one));
  }
  const auto limits = assessment::difference_limits(totals);
  return {{"raters", trials.front()->raters},
          {"trials", trials.size()},
          {"simulated",
           std::ranges::any_of(trials, [](const RatedTrial* one) { return one->simulated; })},
          {"total", agreement_json(assessment::rating_agreement(totals, {}))},
          {"items", std::move(items)},
          {"totals", totals_json(totals)},
          {"differences",
           limits ? Json{{"mean", limits->mean}, {"low", limits->low}, {"high", limits->high}}
                  : Json()}};
}

Result<http::Response> rating_agreement_response(const Call& call) {
  struct Found {
    store::RubricVersion version;
    std::vector<RatedTrial> trials;
  };
  const auto found = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Found> {
    auto version = TRY(rubric_version(tx, call.text("rubric"), call.integer("version")));
    auto trials = TRY(rated_trials(tx, call));
    return Found{std::move(version), std::move(trials)};
  }));
  const auto rubric = TRY(stored_rubric(found.version));
  std::map<std::vector<std::string>, RatedTogether> by_raters;
  for (const RatedTrial& one : found.trials) by_raters[one.raters].push_back(&one);
  std::vector<RatedTogether> sorted;
  for (const auto& [_, trials] : by_raters) sorted.push_back(trials);
  std::ranges::stable_sort(
      sorted, [](const RatedTogether& a, const RatedTogether& b) { return a.size() > b.size(); });
  Json groups = Json::array();
  for (const RatedTogether& trials : sorted) groups.push_back(group_json(trials, rubric));
  return json_response({{"title", found.version.title}, {"groups", std::move(groups)}});
}

std::vector<schema::Field> agreement_fields() {
  using namespace schema;
  const auto share = [](const char* meaning) { return nullable(number("1", meaning)); };
  return {
      {"single", share("ICC(2,1): of one rater, two-way random, absolute agreement; null where "
                       "there is none")},
      {"single_low", share("Low end of its 95 % interval")},
      {"single_high", share("High end of its 95 % interval")},
      {"mean", share("ICC(2,k): of the mean of all raters, absolute agreement; null where there "
                     "is none")},
      {"mean_low", share("Low end of its 95 % interval")},
      {"mean_high", share("High end of its 95 % interval")},
      {"kappa", share("Cohen's kappa, weighted by the squares of the disagreements; null for "
                      "sums of items and for more than two raters")},
      {"note", text("Why there is no ICC; empty if there is")}};
}

std::vector<NamedSchema> agreement_schemas() {
  using namespace schema;
  auto of_item = agreement_fields();
  of_item.emplace_back("label", text("Name of the item"));
  const Json differences =
      object({{"mean", number("1", "Mean of the differences of the sums, first rater less second")},
              {"low", number("1", "Low limit of agreement: mean - 1.96 SD")},
              {"high", number("1", "High limit of agreement: mean + 1.96 SD")}});
  const Json group = object(
      {{"raters", array(text("Name of an account"), "Raters, by name")},
       {"trials", integer("1", "Number of trials that all of them have rated")},
       {"simulated", truth("True if a simulated hand did some of the trials")},
       {"total", ref("RatingAgreement")},
       {"items", array(object(of_item), "Agreement on each item, in the rubric's order")},
       {"totals", array(array(number("1", "Sum of the points by one rater"), "Sums by rater"),
                        "Sums of the points of each trial")},
       {"differences", nullable(differences)}});
  return {{"RatingAgreement", object(agreement_fields())},
          {"RatingAgreements",
           object({{"title", text("Title of the rubric")},
                   {"groups", array(group, "By who rated together, most trials first")}})}};
}

}  // namespace

std::vector<RouteInfo> rating_agreement_routes() {
  RouteInfo out{.method = "GET",
                .path = "/api/v1/ratings/agreement",
                .id = "ratingAgreement",
                .summary =
                    "Compute how far the raters of a rubric agree, of trials that all of "
                    "them have rated without seeing another's rating",
                .who = raters(),
                .parameters = {},
                .body = "",
                .answer = "RatingAgreements",
                .schemas = agreement_schemas(),
                .handle = rating_agreement_response};
  out.parameters = {{.in = Parameter::In::query,
                     .name = "rubric",
                     .kind = Parameter::Kind::text,
                     .unit = "",
                     .meaning = "Id of the rubric",
                     .fallback = std::nullopt},
                    {.in = Parameter::In::query,
                     .name = "version",
                     .kind = Parameter::Kind::integer,
                     .unit = "1",
                     .meaning = "Version of the rubric",
                     .low = 1,
                     .high = kMostVersions,
                     .fallback = std::nullopt}};
  return {out};
}

}  // namespace api
}  // namespace tractus
