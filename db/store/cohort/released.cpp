#include "db/store/cohort/released.hpp"

#include <algorithm>
#include <chrono>

#include "core/clock.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

constexpr double kDayLength_us = 86'400e6;
constexpr std::int64_t kMostKnown = 1'000'000;

double year_of(std::int64_t utc_us) {
  using namespace std::chrono;
  const sys_days day = floor<days>(sys_time<microseconds>(microseconds(utc_us)));
  const year_month_day date(day);
  const sys_days first(date.year() / January / 1), next((date.year() + years(1)) / January / 1);
  return int(date.year()) + double((day - first).count()) / double((next - first).count());
}

core::Result<void> check_there(Reading& tx, const std::string& study) {
  if (study.empty()) return {};
  auto known = TRY(series_exists(tx, study));
  if (known) return {};
  return core::Error{core::Errc::not_found, "study: there is no study " + study.substr(0, 32)};
}

}  // namespace

ReleasedTrial::ReleasedTrial(CohortTrial trial, Tier released, const std::string& person,
                             const Pseudonyms& names)
    : id(names.trial(trial.summary.id)),
      participant(names.person(person)),
      study(std::move(trial.study)),
      level(std::move(trial.level)),
      case_title(std::move(trial.summary.case_title)),
      cohort(std::move(trial.cohort)),
      date(core::utc_text(trial.summary.started_utc_us).substr(0, 10)),
      year(year_of(trial.summary.started_utc_us)),
      rig(trial.rig),
      number(trial.number),
      experience_years(trial.experience_years),
      duration_s(trial.summary.duration_s),
      samples(trial.summary.samples),
      simulated(trial.summary.simulated),
      complete(trial.complete),
      place(trial.place),
      assessed(trial.summary.state == AssessmentState::assessed),
      correct(trial.summary.correct),
      metrics(std::move(trial.metrics)),
      tier(released),
      sha256_(std::move(trial.sha256)),
      started_utc_us_(trial.summary.started_utc_us) {}

core::Result<std::string> ReleasedTrial::file(Tier wanted) const {
  if (tier >= wanted) return sha256_;
  return core::Error{core::Errc::forbidden, "the person who did this trial consented to the tier " +
                                                std::string(name(tier)) +
                                                ", but this request needs the tier " +
                                                std::string(name(wanted))};
}

core::Result<ReleasedTrials> ReleasedTrials::read(Reading& tx,
                                                  const std::optional<PseudonymKey>& key,
                                                  const Wish& wish) {
  const auto names = TRY(Pseudonyms::of(key));
  TRY(check_there(tx, wish.study));
  auto trials = TRY(CohortRows::read(tx, wish.study, wish.most));
  const auto book = TRY(ConsentBook::read(tx));
  ReleasedTrials out;
  out.take(std::move(trials), book, names, wish.least);
  out.count_days();
  return out;
}

void ReleasedTrials::take(std::vector<CohortTrial> trials, const ConsentBook& book,
                          const Pseudonyms& names, Tier least) {
  for (CohortTrial& trial : trials) {
    const Tier tier = book.tier_of(trial);
    const bool agreed = tier >= least && tier != Tier::none;
    if (trial.blind) ++blind_;
    if (!trial.blind && !agreed) ++without_consent_;
    if (trial.blind || !agreed) continue;
    const std::string person = book.person_of(trial);
    trials_.push_back(ReleasedTrial(std::move(trial), tier, person, names));
  }
}

void ReleasedTrials::count_days() {
  std::map<std::string, std::int64_t> first;
  for (ReleasedTrial& trial : trials_) {
    const auto at = first.try_emplace(trial.participant, trial.started_utc_us_).first;
    trial.days = double(trial.started_utc_us_ - at->second) / kDayLength_us;
  }
}

ReleasedTrials ReleasedTrials::at_least(Tier tier) const {
  ReleasedTrials out = *this;
  std::erase_if(out.trials_, [&](const ReleasedTrial& trial) { return trial.tier < tier; });
  return out;
}

core::Result<std::map<std::string, std::string>> who_is_who(
    Reading& tx, const std::optional<PseudonymKey>& key) {
  const auto names = TRY(Pseudonyms::of(key));
  auto trials = TRY(CohortRows::read(tx, "", kMostKnown));
  const auto book = TRY(ConsentBook::read(tx));
  std::map<std::string, std::string> out;
  for (const CohortTrial& trial : trials) {
    const std::string person = book.person_of(trial);
    out[names.person(person)] = person;
  }
  return out;
}

core::Result<std::int64_t> scored_trials(Reading& tx, const std::string& study) {
  TRY(check_there(tx, study));
  auto rows = TRY(tx.query(
      "select count(*) from trials t left join study_trials m on m.trial_id = t.id left join "
      "study_slots l on l.id = m.slot_id where t.complete = 1 and t.state = 'assessed' and "
      "(m.state is null or m.state = 'counts') and (? = '' or l.study_id = ?)",
      {study, study}));
  return rows.front().integer(0);
}

}  // namespace store
}  // namespace tractus
