#include "station/sensors/netft.hpp"

#include "fuzz/target.hpp"

namespace tractus {
namespace fuzz {
namespace {
bool run(core::ByteView bytes) {
  const auto record = sensors::parse_rdt(bytes);
  core::require(record.has_value() == (bytes.size() == sensors::kRdtBytes),
                "a record is 36 bytes, whatever they are");
  if (record)
    for (const auto of : {sensors::NetFtStatus::box, sensors::NetFtStatus::axia})
      core::require(!sensors::status_words(record->status, of).empty(), "a status has words");
  const auto page = sensors::parse_netft_xml(core::text_of(bytes), "it");
  if (!taken(page)) return record.has_value();
  core::require(page->counts_per_N > 0.0 && page->counts_per_Nm > 0.0 && page->rate_Hz > 0.0,
                "counts and rate are above 0");
  return true;
}
}  // namespace

Target netft() {
  return {"netft", "an ATI Net F/T's page and its RDT records, from the network", {}, run};
}

}  // namespace fuzz
}  // namespace tractus
