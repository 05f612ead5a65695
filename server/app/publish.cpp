#include "server/app/publish.hpp"

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "server/jobs/publish.hpp"

namespace tractus::app {

core::Result<std::string> publish(DataFolder& data, const std::filesystem::path& bundle) {
  auto manifest = TRY(core::read_file(bundle / "case.json", 16u << 20));
  const store::AuditScope acting(command_act("publish", {{"case", core::sha256(manifest)}}));
  return jobs::publish_bundle(data.store, data.objects, bundle);
}

}  // namespace tractus::app
