/// Published cases and their parts.
#pragma once

#include <vector>

#include "core/named.hpp"
#include "db/store/finding/list.hpp"
#include "db/store/store.hpp"
#include "trial/trial.hpp"

namespace tractus::store {

/// Whether a case's breaches can be told by feel, by its certificate.
enum class Felt {
  untried,    ///< no certificate yet: a job will try it
  told,       ///< all of them
  not_told,   ///< not all of them
  not_known,  ///< of a case whose drilled bone does not say, or with nothing to tell
};
constexpr auto words(Felt) {
  using enum Felt;
  return std::to_array<core::Word<Felt>>(
      {{untried, "untried"}, {told, "told"}, {not_told, "not_told"}, {not_known, "not_known"}});
}

struct CaseSummary {
  std::string id;  ///< SHA-256 of case.json; of a scenario, its version's id
  std::string title;
  std::string source;
  std::int64_t made_utc_us = 0;
  std::uint64_t trials = 0;  ///< counted on reading
  /// Palpation: a volume with a tract. Probing: a scenario, whose only part, scenario.json, is secret.
  trial::Rig kind = trial::Rig::palpation;
  bool retired = false;  ///< new assignments cannot use it; existing ones continue
  bool planned = false;  ///< the bone is whole: a trainee drills the channel, then palpates it
  Felt felt = Felt::untried;
};

/// A file of the bundle, case.json and case.sig among them.
struct CasePart {
  std::string name;
  std::string sha256;  ///< of the object that holds it
  std::uint64_t size_bytes = 0;
  bool secret = false;  ///< stations cannot read it
};

/// Stores the case, its parts and their objects. Storing the same case again changes nothing,
/// except the field `planned` of a case that an older version stored.
core::Result<void> add_case(Writing& tx, const CaseSummary& summary,
                            const std::vector<CasePart>& parts, std::int64_t now_utc_us);
/// The list of palpation cases (finding/list.hpp), in which scenarios never are: its orders and filters.
const ListShape& case_list();
struct FoundCases {
  std::vector<CaseSummary> cases;
  ListPage page;
};
core::Result<FoundCases> find_cases(Reading& tx, const ListRequest& request);
core::Result<std::optional<CaseSummary>> case_of(Reading& tx, const std::string& id);
/// Retires a case, or offers it again. Errors: not_found.
core::Result<void> set_case_retired(Writing& tx, const std::string& id, bool retired,
                                    std::int64_t now_utc_us);
/// Notes what was found of an untried case, with its certificate as a part where there is one; of
/// any other case nothing changes.
core::Result<void> set_case_felt(Writing& tx, const std::string& id, Felt felt,
                                 const std::optional<CasePart>& certificate,
                                 std::int64_t now_utc_us);
/// Palpation cases with a channel that nobody has tried and that no job was ever made for, oldest first.
core::Result<std::vector<std::string>> untried_cases(Reading& tx);
core::Result<std::optional<CasePart>> case_part(Reading& tx, const std::string& case_id,
                                                const std::string& name);

/// Records a file that is among the objects; an already recorded file stays unchanged.
core::Result<void> add_object(Writing& tx, const std::string& sha256, std::uint64_t size_bytes,
                              std::int64_t now_utc_us);
/// Bytes of a recorded file; 0 if none is recorded.
core::Result<std::uint64_t> object_size_bytes(Reading& tx, const std::string& sha256);

}  // namespace tractus::store
