/// What a case would be worth to the hand, while it is planned.
#include <map>
#include <mutex>

#include "cases/making.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/cases/tract_plan.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/jobs/make_case.hpp"
#include "server/jobs/source_volume.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Json;
using core::Result;

/// Each person's newest question: an older one, about a tract that was moved since, is called off.
class NewestQuestion {
 public:
  std::uint64_t ask(const std::string& who) {
    const std::lock_guard held(mutex_);
    return ++newest_[who];
  }
  bool is_newest(const std::string& who, std::uint64_t question) {
    const std::lock_guard held(mutex_);
    return newest_[who] == question;
  }

 private:
  std::mutex mutex_;
  std::map<std::string, std::uint64_t> newest_;
};

NewestQuestion& newest_question() {
  static NewestQuestion questions;
  return questions;
}

Json answer_of(const Result<cases::Certificate>& certificate) {
  if (!certificate)
    return {{"certificate", Json()}, {"warning", ""}, {"problem", certificate.error().what}};
  return {{"certificate", certificate->to_json()},
          {"warning", certificate->warning()},
          {"problem", ""}};
}

/// What is wrong with the plan is part of the answer; that it was called off, or that reading
/// failed, is not.
bool is_of_plan(Errc code) { return code == Errc::out_of_range || code == Errc::bad_input; }

Result<http::Response> certify_plan(const Call& call) {
  const auto question = newest_question().ask(call.caller.id);
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const auto effort = fields.word<cases::Effort>("effort");
  auto plan = TRY(jobs::plan_from(fields));
  TRY(fields.done());
  const auto source =
      TRY(jobs::released_volume(call.backend.store, call.backend.objects, call.text("id")));
  const auto ct = jobs::read_about(source.file, plan.entry_m, plan.target_m);
  if (!ct && is_of_plan(ct.error().code)) return json_response(answer_of(ct.error()));
  if (!ct) return ct.error();
  plan.breach.reset();  // every wall is tried where it is told best, whichever is asked for
  const auto found = cases::certify(*ct, models::PalpationModel{}, plan, effort, [&](double) {
    return newest_question().is_newest(call.caller.id, question);
  });
  if (!found && !is_of_plan(found.error().code)) return found.error();
  return json_response(answer_of(found));
}

Json numbers_by_place(const char* what) {
  return schema::array(schema::nullable(schema::number("1", what)),
                       std::string(what) + ", for each depth");
}

Json certificate_wish() {
  std::vector<schema::Field> fields = plan_fields();
  fields.emplace(
      fields.begin(), "effort",
      schema::one_of<cases::Effort>("first: one place of each wall; whole: every place"));
  return schema::object(fields);
}

Json perception_schema() {
  using namespace schema;
  return object(
      {{"force_weber", number("1", "Just noticeable difference of a force, as a share of it")},
       {"force_threshold_N", number("N", "Smallest force that is felt")},
       {"wander_m", number("m", "Standard deviation of the hand's position")}});
}

/// d′ of each wall under another assumption.
Json sensitivity_schema(const Json& d) {
  using namespace schema;
  std::vector<Field> walls;
  for (const std::string& wall : core::names<volume::Wall>()) walls.emplace_back(wall, d);
  return object({{"assumption", text("Number of the perception that is changed")},
                 {"value", number("the assumption's", "Its value")},
                 {"d_prime", object(walls)}});
}

std::vector<NamedSchema> certificate_schemas() {
  using namespace schema;
  const Json d = nullable(number("1", "In standard deviations; null where it was not tried"));
  return {
      {"TriedPlaces",
       object({{"at_m", array(number("m", "Depth along the tract, in metres"), "Depths")},
               {"k", numbers_by_place("d′ against the whole twin")},
               {"b", numbers_by_place("d′ against the tract's other places")},
               {"fa", numbers_by_place("d′ of the worst whole place")}})},
      {"WallCertificate",
       object({{"wall", one_of<volume::Wall>("Wall of the tract")},
               {"passes", truth("True if a breach of this wall can be told")},
               {"at_m", nullable(number("m", "Depth of the breach along the tract, in metres"))},
               {"k", d},
               {"b", d},
               {"fa", d},
               {"fa_wall", nullable(one_of<volume::Wall>("Wall of the place of FA"))},
               {"fa_at_m", nullable(number("m", "Depth of the place of FA, in metres"))},
               {"motion", nullable(one_of<cases::Motion>("How the hand tells it best"))},
               {"contrast", nullable(one_of<cases::Contrast>("With what it compares"))},
               {"lean_m", number("m", "Lean of the tip there, in metres")},
               {"force_N", number("N", "Force of whole bone there, in newtons")},
               {"foretold", number("1",
                                   "Share of right answers that a hand is foretold which "
                                   "presses with the tip first")},
               {"end_force_N", nullable(number("N", "Force of the whole end, in newtons"))},
               {"why_not", nullable(text("Why no breach was tried, as a sentence"))},
               {"places", ref("TriedPlaces")}})},
      {"CaseCertificate",
       object({{"format", text("tractus-certificate/1")},
               {"passes", truth("True if a breach of every wall can be told")},
               {"preparation", one_of<volume::Preparation>("How the bone is prepared")},
               {"perception", perception_schema()},
               {"walls", array(ref("WallCertificate"), "Walls in the order of PlannedTract")},
               {"sensitivities", array(sensitivity_schema(d), "One assumption at a time")}})},
      {"CertificateWish", certificate_wish()},
      {"PlannedCertificate",
       object({{"certificate", nullable(ref("CaseCertificate"))},
               {"warning", text("Walls that cannot be told, as a sentence; empty if all can")},
               {"problem", text("Why there is no certificate, as a sentence; else empty")}})}};
}

}  // namespace

std::vector<RouteInfo> certificate_routes() {
  RouteInfo out{.method = "POST",
                .path = "/api/v1/volumes/{id}/certificate",
                .id = "certifyTract",
                .summary =
                    "Let an ideal observer palpate a planned tract: what a trainee could "
                    "tell of a breach of each wall. A newer request of the same person "
                    "calls an older one off",
                .who = {Role::admin, Role::faculty},
                .parameters = {path_text("id", "Id of the volume")},
                .body = "CertificateWish",
                .body_limit_bytes = kMaxPlan_bytes,
                .answer = "PlannedCertificate",
                .schemas = certificate_schemas(),
                .handle = certify_plan};
  out.audited = false;  // it changes nothing
  out.lane = http::Lane::computing;
  return {out};
}

}  // namespace api
}  // namespace tractus
