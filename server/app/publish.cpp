#include "server/app/publish.hpp"

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "server/jobs/publish.hpp"

namespace tractus::app {

core::Result<std::string> publish(DataFolder& data, const std::filesystem::path& bundle) {
  auto manifest = core::read_file(bundle / "case.json", 16u << 20);
  if (!manifest) return manifest.error();
  const store::AuditScope acting(command_act("publish", {{"case", core::sha256(*manifest)}}));
  return jobs::publish_bundle(data.store, data.objects, bundle);
}

}  // namespace tractus::app
