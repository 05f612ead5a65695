#include "server/jobs/publish.hpp"

#include "cases/case.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "db/store/cases/cases.hpp"

namespace tractus {
namespace jobs {
namespace fs = std::filesystem;
namespace {

/// A small file that is a part though the manifest cannot name it.
core::Result<store::CasePart> put_file(const store::Objects& objects, const fs::path& file) {
  auto bytes = core::read_file(file, 16u << 20);
  if (!bytes) return bytes.error();
  auto sha256 = objects.put(*bytes);
  if (!sha256) return sha256.error();
  return store::CasePart{file.filename().string(), *sha256, bytes->size(), false};
}

}  // namespace

core::Result<std::string> publish_bundle(
    store::Store& store, const store::Objects& objects, const fs::path& bundle,
    const std::function<core::Result<void>(store::Writing&, const std::string& id)>& also) {
  auto opened = cases::open_case(bundle);
  if (!opened) return opened.error();
  if (auto truth = cases::read_truth(*opened); !truth) return truth.error();
  std::vector<store::CasePart> parts;
  for (const char* name : {"case.json", "case.sig"}) {
    auto part = put_file(objects, bundle / name);
    if (!part) return part.error();
    parts.push_back(std::move(*part));
  }
  if (parts.front().sha256 != opened->id)
    return core::Error{core::Errc::corrupt,
                       (bundle / "case.json").string() + ": changed meanwhile"};
  for (const cases::Part& part : opened->definition.parts) {
    std::error_code failure;
    if (part.secret && !fs::exists(bundle / part.name, failure)) continue;
    if (auto in = objects.copy_in(bundle / part.name, part.sha256); !in) return in.error();
    parts.push_back({part.name, part.sha256, part.size_bytes, part.secret});
  }
  store::CaseSummary summary{opened->id, opened->definition.title, opened->definition.source,
                             opened->definition.made_utc_us, 0};
  summary.planned = opened->definition.planned;
  auto noted = store.write([&](store::Writing& tx) -> core::Result<void> {
    if (auto added = store::add_case(tx, summary, parts, core::utc_us()); !added) return added;
    return also ? also(tx, opened->id) : core::Result<void>();
  });
  if (!noted) return noted.error();
  return opened->id;
}

}  // namespace jobs
}  // namespace tractus
