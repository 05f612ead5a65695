/// People who leave: their account loses its name, their trials are erased or stay as nobody's (ADR-0052).
///
/// `begin_erasure` changes all records in the caller's transaction. What cannot be part of a transaction, files and the old rows of the
/// audit trail, is left to `finish_erasure`, which is right again after any interruption.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/named.hpp"
#include "db/store/operations/redaction.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::store {

enum class ErasureMode {
  erase,  ///< the person's trials too
  anonymise,  ///< trials and scores stay, by their pseudonym, which nothing links to the person any more
};
constexpr auto words(ErasureMode) {
  return std::to_array<core::Word<ErasureMode>>(
      {{ErasureMode::erase, "erase"}, {ErasureMode::anonymise, "anonymise"}});
}

enum class ErasureCause { asked, retention, restored };
constexpr auto words(ErasureCause) {
  using enum ErasureCause;
  return std::to_array<core::Word<ErasureCause>>(
      {{asked, "asked"}, {retention, "retention"}, {restored, "restored"}});
}

enum class ErasureState { begun, done };
constexpr auto words(ErasureState) {
  using enum ErasureState;
  return std::to_array<core::Word<ErasureState>>({{begun, "begun"}, {done, "done"}});
}

/// What becomes of a table's rows that are about the person.
enum class Fate { removed, changed, kept, none };
constexpr auto words(Fate) {
  using enum Fate;
  return std::to_array<core::Word<Fate>>(
      {{removed, "removed"}, {changed, "changed"}, {kept, "kept"}, {none, "none"}});
}

/// The decision on a table of the schema. A table without one fails a test (erasure_test.cpp).
struct TableDecision {
  std::string resource;  ///< folder of db/store
  std::string table;
  Fate erase, anonymise;  ///< none: its rows are about nobody
  std::string what;       ///< its rows, for a person: "sessions"
  std::string reason;     ///< of what is changed or kept
};
const std::vector<TableDecision>& table_decisions();

struct Erasure {
  std::int64_t number = 0;  ///< opaque: the person's alias is made of it
  std::string account_id = {};
  ErasureMode mode = ErasureMode::erase;
  ErasureCause cause = ErasureCause::asked;
  ErasureState state = ErasureState::begun;
  std::int64_t begun_utc_us = 0;
  std::string alias() const { return "erased person " + std::to_string(number); }
};

/// Number of rows by table.
using RowCounts = std::map<std::string, std::uint64_t>;
struct Departure {
  Erasure erasure = {};
  RowCounts rows = {};      ///< removed or changed
  std::uint64_t files = 0;  ///< recordings that are deleted
  std::uint64_t file_bytes = 0;
  std::uint64_t open_uploads = 0;  ///< of `files`: not here completely yet
  std::uint64_t trail_rows =
      0;  ///< rows of the audit trail that name the person; only in a preview
};

/// @param wish  account, mode, cause and time; its number is taken if it is free, else the next one
/// Errors: not_found; conflict if the person is erased already, or another account has the alias.
core::Result<Departure> begin_erasure(Writing& tx, const Erasure& wish);
/// What begin_erasure would do; changes nothing.
core::Result<Departure> preview_erasure(Store& store, const Erasure& wish);

/// Deletes the files and takes the person out of the audit trail. Call it for every erasure of unfinished_erasures, also at the start
/// of a server.
core::Result<void> finish_erasure(Store& store, const Objects& objects,
                                  const PartialFiles& partials, std::int64_t number,
                                  std::int64_t now_utc_us);
core::Result<std::vector<std::int64_t>> unfinished_erasures(Reading& tx);
/// By number.
core::Result<std::vector<Erasure>> all_erasures(Reading& tx);
core::Result<bool> is_erased(Reading& tx, const std::string& account_id);

/// For a station that still has work of a person who left. Errors: conflict if the slot or the trial went with its person.
core::Result<void> check_slot_stays(Reading& tx, const std::string& slot_id);
core::Result<void> check_trial_stays(Reading& tx, const std::string& trial_id);

/// What is wrong: erasures that are not finished, files of erased trials that are still here.
core::Result<std::vector<std::string>> erasure_findings(Reading& tx, const Objects& objects);

}  // namespace tractus::store
