#include "server/jobs/publish.hpp"

#include "cases/case.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/jobs.hpp"

namespace tractus {
namespace jobs {
namespace fs = std::filesystem;
namespace {

/// A small file that is a part though the manifest cannot name it.
core::Result<store::CasePart> put_file(const store::Objects& objects, const fs::path& file) {
  auto bytes = TRY(core::read_file(file, 16u << 20));
  auto sha256 = TRY(objects.put(bytes));
  return store::CasePart{file.filename().string(), sha256, bytes.size(), false};
}

store::Felt felt_of(const cases::Case& made) {
  if (made.planned) return store::Felt::not_known;
  if (!made.certified) return store::Felt::untried;
  return *made.certified ? store::Felt::told : store::Felt::not_told;
}

}  // namespace

core::Result<std::string> publish_bundle(
    store::Store& store, const store::Objects& objects, const fs::path& bundle,
    const std::function<core::Result<void>(store::Writing&, const std::string& id)>& also) {
  auto opened = TRY(cases::open_case(bundle));
  TRY(cases::read_truth(opened));
  std::vector<store::CasePart> parts;
  for (const char* name : {"case.json", "case.sig"}) {
    auto part = TRY(put_file(objects, bundle / name));
    parts.push_back(std::move(part));
  }
  if (parts.front().sha256 != opened.id)
    return core::Error{core::Errc::corrupt, (bundle / "case.json").string() +
                                                ": the file was changed while it was read"};
  for (const cases::Part& part : opened.definition.parts) {
    std::error_code failure;
    if (part.secret && !fs::exists(bundle / part.name, failure)) continue;
    TRY(objects.copy_in(bundle / part.name, part.sha256));
    parts.push_back({part.name, part.sha256, part.size_bytes, part.secret});
  }
  store::CaseSummary summary{opened.id, opened.definition.title, opened.definition.source,
                             opened.definition.made_utc_us, 0};
  summary.planned = opened.definition.planned;
  summary.felt = felt_of(opened.definition);
  TRY(store.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::add_case(tx, summary, parts, core::utc_us()));
    if (summary.felt == store::Felt::untried)
      TRY(store::queue_job(tx, store::JobKind::felt, opened.id, core::utc_us()));
    return also ? also(tx, opened.id) : core::Result<void>();
  }));
  return opened.id;
}

}  // namespace jobs
}  // namespace tractus
