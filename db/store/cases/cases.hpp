/// Published cases and their parts.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

/// What a case is: a volume with a tract, or a probing scenario (its one part, scenario.json, is
/// secret).
inline constexpr const char* kPalpation = "palpation";
inline constexpr const char* kProbing = "probing";

struct CaseSummary {
  std::string id;  ///< SHA-256 of case.json; of a scenario, its version's id
  std::string title;
  std::string source;
  std::int64_t made_utc_us = 0;
  std::uint64_t trials = 0;  ///< counted on reading
  std::string kind = kPalpation;
  bool retired = false;  ///< offered no more; what was assigned of it goes on
  bool planned = false;  ///< the bone is whole: a channel is drilled first, and felt then
};

/// A file of the bundle, case.json and case.sig among them.
struct CasePart {
  std::string name;
  std::string sha256;  ///< of the object that holds it
  std::uint64_t size_bytes = 0;
  bool secret = false;  ///< never for a station
};

/// Notes the case, its parts and their objects. Publishing the same case again changes nothing (of
/// one noted before `planned` was kept, that alone).
core::Result<void> add_case(Writing& tx, const CaseSummary& summary,
                            const std::vector<CasePart>& parts, std::int64_t now_utc_us);
/// Those for palpation, newest first: scenarios are nobody's to list.
core::Result<std::vector<CaseSummary>> all_cases(Reading& tx);
core::Result<std::optional<CaseSummary>> case_of(Reading& tx, const std::string& id);
/// Offered no more, or again. Errors: not_found.
core::Result<void> set_case_retired(Writing& tx, const std::string& id, bool retired,
                                    std::int64_t now_utc_us);
core::Result<std::optional<CasePart>> case_part(Reading& tx, const std::string& case_id,
                                                const std::string& name);

/// Notes a file that lies among the objects; one that is known already stays as it is.
core::Result<void> add_object(Writing& tx, const std::string& sha256, std::uint64_t size_bytes,
                              std::int64_t now_utc_us);

}  // namespace tractus::store
