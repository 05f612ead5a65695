#include "server/jobs/certify_case.hpp"

#include "cases/making.hpp"
#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/jobs.hpp"
#include "server/jobs/case_facts.hpp"

namespace tractus {
namespace jobs {
namespace {

/// Errors: out_of_range where the drilled bone does not say.
core::Result<cases::Certificate> late_certificate(store::Store& store,
                                                  const store::Objects& objects,
                                                  const std::string& case_id) {
  const auto facts = TRY(case_facts(store, objects, case_id));
  const auto part = TRY(store.read(
      [&](store::Reading& tx) { return store::case_part(tx, case_id, cases::kVolumePart); }));
  if (!part || !facts.truth)
    return core::Error{core::Errc::not_found, "case " + case_id + " lacks its volume or truth"};
  const auto file = TRY(volume::VolumeFile::open(TRY(objects.file(part->sha256))));
  return cases::certify_drilled(TRY(file.read_all()), facts.definition, *facts.truth);
}

core::Result<void> mark(store::Store& store, const std::string& case_id, store::Felt felt,
                        const std::optional<store::CasePart>& certificate) {
  return store.write([&](store::Writing& tx) {
    return store::set_case_felt(tx, case_id, felt, certificate, core::utc_us());
  });
}

}  // namespace

core::Result<void> certify_case(store::Store& store, const store::Objects& objects,
                                const std::string& case_id) {
  const auto known =
      TRY(store.read([&](store::Reading& tx) { return store::case_of(tx, case_id); }));
  if (!known) return core::Error{core::Errc::not_found, "no case " + case_id};
  if (known->felt != store::Felt::untried) return {};
  const auto found = late_certificate(store, objects, case_id);
  if (!found && found.error().code != core::Errc::out_of_range) return found.error();
  if (!found) return mark(store, case_id, store::Felt::not_known, std::nullopt);
  const std::string text = found->to_json().dump(2) + "\n";
  const auto sha256 = TRY(objects.put(core::bytes_of(text)));
  return mark(store, case_id, found->passes() ? store::Felt::told : store::Felt::not_told,
              store::CasePart{cases::kCertificatePart, sha256, text.size(), true});
}

core::Result<void> queue_untried_cases(store::Store& store) {
  const auto untried = TRY(store.read([](store::Reading& tx) { return store::untried_cases(tx); }));
  if (untried.empty()) return {};
  return store.write([&](store::Writing& tx) -> core::Result<void> {
    for (const auto& id : untried)
      TRY(store::queue_job(tx, store::JobKind::felt, id, core::utc_us()));
    return {};
  });
}

}  // namespace jobs
}  // namespace tractus
