#include "server/jobs/make_case.hpp"

#include <fmt/format.h>

#include <chrono>

#include "cases/case.hpp"
#include "cases/making.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/case_makings.hpp"
#include "server/jobs/publish.hpp"
#include "server/jobs/source_volume.hpp"

namespace tractus {
namespace jobs {
namespace {

using core::Json;
using core::Result;

constexpr double kAny_m = 1e3;
constexpr std::chrono::milliseconds kBetweenReports{300};
/// Shares of the whole that are over when a step begins.
constexpr double kCarving = 0.2, kWriting = 0.6;

math::Vec3 point(core::Fields& fields, const char* key) {
  const auto numbers = fields.numbers(key, 3);
  return {numbers[0], numbers[1], numbers[2]};
}

/// @param even  CarvingPlan::even
Result<volume::BreachPlan> breach_from(const Json& json, const std::string& where, bool& even) {
  core::Fields fields(json, where);
  volume::BreachPlan out;
  out.wall = fields.word<volume::Wall>("wall");
  out.depth_m = fields.number_or("depth_m", out.depth_m, -kAny_m, kAny_m);
  if (fields.has("at_m")) out.at_m = fields.number("at_m", -kAny_m, kAny_m);
  if (const Json* given = fields.member("even", false)) {
    if (!given->is_boolean())
      fields.wrong("even", "true or false is expected");
    else
      even = given->get<bool>();
    if (even && out.at_m) fields.wrong("even", "a breach with a stated place cannot be moved");
  }
  TRY(fields.done());
  return out;
}

/// Notes how far the making is about three times a second; ends when the server does.
class Noting {
 public:
  Noting(store::Store& store, std::string id, const std::function<bool()>& ending)
      : store_(store), id_(std::move(id)), ending_(ending) {}
  core::Progress at(std::string phase, double from, double to) {
    next_ = {};
    return [this, phase = std::move(phase), from, to](double share) {
      return note(phase, from + (to - from) * share);
    };
  }

 private:
  bool note(const std::string& phase, double share) {
    if (ending_()) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return true;
    next_ = now + kBetweenReports;
    // A database that is busy for once stops nothing.
    (void)store_.write([&](store::Writing& tx) {
      return store::note_making(tx, id_, share, phase, core::utc_us());
    });
    return true;
  }
  store::Store& store_;
  std::string id_;
  const std::function<bool()>& ending_;
  std::chrono::steady_clock::time_point next_{};
};

cases::NewCase new_case(const store::CaseMaking& making, const SourceVolume& source,
                        const models::PalpationModel& model, const cases::Made& carved) {
  cases::NewCase out{.definition = {},
                     .truth = carved.truth(),
                     .volume = carved.volume,
                     .meta = {source.source, carved.drilled ? "part about a tract, drilled"
                                                            : "part about a planned tract"},
                     .draw = {}};
  out.definition.title = making.title;
  out.definition.source = source.source.empty() ? source.name : source.source;
  out.definition.made_utc_us = core::utc_us();
  out.definition.tract = carved.tract;
  out.definition.planned = !carved.drilled;
  out.definition.preparation =
      carved.envelope ? volume::Preparation::filled : volume::Preparation::published;
  out.certificate = carved.certificate;
  out.definition.model = model;
  return out;
}

Result<void> marks_from(core::Fields& fields, cases::CarvingPlan& plan) {
  using volume::EnvelopeMark;
  const Json* given = fields.member("envelope_marks", false);
  if (!given) return {};
  if (!given->is_array() || given->size() > EnvelopeMark::kMostMarks) {
    fields.wrong("envelope_marks",
                 fmt::format("a list of at most {} marks is expected", EnvelopeMark::kMostMarks));
    return {};
  }
  if (!given->empty() && plan.preparation != volume::Preparation::filled)
    fields.wrong("envelope_marks", "published bone has no envelope: ask for filled bone");
  for (std::size_t n = 0; n < given->size(); ++n) {
    core::Fields one((*given)[n], fmt::format("{}/envelope_marks/{}", fields.where(), n));
    EnvelopeMark mark;
    mark.at_m = point(one, "at_m");
    mark.radius_m = one.number("radius_m", EnvelopeMark::kLeast_m, EnvelopeMark::kMost_m);
    const Json* bone = one.member("bone");
    if (bone && !bone->is_boolean()) one.wrong("bone", "true or false is expected");
    TRY(one.done());
    mark.bone = bone->get<bool>();
    plan.envelope_marks.push_back(mark);
  }
  return {};
}

}  // namespace

Result<cases::CarvingPlan> plan_from(core::Fields& fields) {
  cases::CarvingPlan out;
  out.entry_m = point(fields, "entry_m");
  out.target_m = point(fields, "target_m");
  out.radius_m = fields.number_or("radius_m", out.radius_m, 0.0, kAny_m);
  if (fields.has("channel")) {
    const std::string channel = fields.text("channel", 16);
    if (channel != "drilled" && channel != "planned")
      fields.wrong("channel", "drilled or planned is expected");
    out.drilled = channel != "planned";
  }
  out.preparation = fields.word_or("preparation", out.preparation);
  TRY(marks_from(fields, out));
  const Json* breach = fields.member("breach", false);
  if (!breach || breach->is_null()) return out;
  if (!out.drilled)
    fields.wrong("breach", "a planned channel has no breach: give null, or leave the field out");
  auto read = TRY(breach_from(*breach, fields.where() + "/breach", out.even));
  out.breach = read;
  return out;
}

Json plan_json(const cases::CarvingPlan& plan) {
  const auto numbers = [](const math::Vec3& p) { return Json::array({p.x(), p.y(), p.z()}); };
  Json out{{"entry_m", numbers(plan.entry_m)},
           {"target_m", numbers(plan.target_m)},
           {"radius_m", plan.radius_m},
           {"channel", plan.drilled ? "drilled" : "planned"},
           {"preparation", volume::name(plan.preparation)},
           {"breach", Json()}};
  for (const auto& mark : plan.envelope_marks)
    out["envelope_marks"].push_back(
        {{"at_m", numbers(mark.at_m)}, {"radius_m", mark.radius_m}, {"bone", mark.bone}});
  if (!plan.breach) return out;
  out["breach"] = {{"wall", volume::name(plan.breach->wall)}, {"depth_m", plan.breach->depth_m}};
  if (plan.breach->at_m) out["breach"]["at_m"] = *plan.breach->at_m;
  if (plan.even) out["breach"]["even"] = true;
  return out;
}

Result<void> make_case(store::Store& store, const store::Objects& objects, const core::KeyPair& key,
                       const std::string& making_id, const std::function<bool()>& ending) {
  auto making =
      TRY(store.read([&](store::Reading& tx) { return store::case_making_of(tx, making_id); }));
  if (!making)
    return core::Error{core::Errc::not_found, "no job that makes a case has the id " + making_id};
  if (making->state == store::WorkState::done) return {};
  auto json = TRY(core::parse_json(making->plan, "plan"));
  core::Fields fields(json, "plan");
  const auto plan = TRY(plan_from(fields));
  const auto source = TRY(released_volume(store, objects, making->volume_id));
  Noting noting(store, making_id, ending);
  const auto ct = TRY(read_about(source.file, plan.entry_m, plan.target_m,
                                 noting.at("reading the volume", 0.0, kCarving)));
  models::PalpationModel model;
  model.name = "uniform cantilever";
  const auto carved =
      TRY(cases::make(ct, model, plan, noting.at("drilling the tract", kCarving, kWriting)));
  auto scratch =
      TRY(core::ScratchFolder::make(std::filesystem::temp_directory_path() / "tractus-case"));
  const auto bundle = scratch.path() / "case";
  TRY(cases::write_case(bundle, new_case(*making, source, model, carved), key,
                        noting.at("writing and signing", kWriting, 1.0)));
  TRY(publish_bundle(store, objects, bundle, [&](store::Writing& tx, const std::string& id) {
    return store::finish_making(tx, making_id, id, core::utc_us());
  }));
  return {};
}

}  // namespace jobs
}  // namespace tractus
