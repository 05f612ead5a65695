/// Cohorts that were exported last, so that an interrupted download goes on where it broke although
/// trials came in meanwhile.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string_view>

namespace tractus::api {

class CohortArchive;

/// The newest archives, by entity tag. Holds their tables, not their samples. Thread-safe.
class HeldCohorts {
 public:
  static constexpr std::size_t kMost = 4;
  /// The archive, or null.
  std::shared_ptr<CohortArchive> find(std::string_view entity_tag);
  void keep(std::shared_ptr<CohortArchive> archive);
  void drop(const CohortArchive& archive);
  /// Drops all, because somebody's data may be in them no longer.
  void forget();

 private:
  std::mutex mutex_;                                    ///< guards what follows
  std::list<std::shared_ptr<CohortArchive>> archives_;  ///< most recent first
};

}  // namespace tractus::api
