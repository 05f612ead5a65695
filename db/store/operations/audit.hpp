/// The audit trail: who changed what, when, in a chain that shows tampering.
///
/// A row's hash is HMAC-SHA-256 over the previous row's hash and every field of its own, each with
/// its length before it, by a key that is not in the database (RFC 2104). Whoever can write to the
/// database alone can therefore neither alter, take out, insert nor reorder rows unseen. What the
/// chain itself cannot show is that its newest rows were cut off: for that its end is noted
/// elsewhere from time to time (ChainEnd) and compared.
#pragma once

#include <functional>
#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

/// What is being done, by whom: noted in the same transaction as the first change it makes, so that
/// there is no change without its row and no row without its change.
struct AuditedAction {
  std::string who = {};       ///< name of the account or the station; "command line: USER"
  std::string role = {};      ///< as api::Role names it, or "command line"
  std::string peer = {};      ///< address it came from; empty: this machine
  std::string what = {};      ///< the route's id, or the command
  std::string object = {};    ///< the path's arguments
  std::string detail = "{}";  ///< JSON; never holds a password or a code
  std::int64_t at_utc_us = 0;
};

/// While it lives, the first write of this thread that succeeds is noted as this act.
class AuditScope {
 public:
  explicit AuditScope(AuditedAction act);
  ~AuditScope();
  AuditScope(const AuditScope&) = delete;
  AuditScope& operator=(const AuditScope&) = delete;
  /// Names who acts, once that is known: at signing in.
  static void is_by(const std::string& who, const std::string& role);
  /// Keeps nothing of what was sent: it may be a secret in the wrong field.
  static void without_detail();

 private:
  friend core::Result<void> note_act(Writing& tx, const AuditKey& key, const std::string& changes);
  friend void act_was_noted() noexcept;
  friend bool act_waits() noexcept;
  AuditedAction act_;
  bool noted_ = false;
};

struct AuditRow {
  std::int64_t number = 0;  ///< from 1, without gaps
  AuditedAction act;
  std::string hash;
  std::string changes;  ///< digests of the covered rows that changed (coverage.hpp); "" for none
};

/// Newest first, of those before `number`; at most `limit`.
core::Result<std::vector<AuditRow>> audit_before(Reading& tx, std::int64_t number,
                                                 std::int64_t limit);
/// Notes an act; one that changes nothing else, as a refusal, has no `changes`.
core::Result<void> add_act(Writing& tx, const AuditKey& key, const AuditedAction& act,
                           const std::string& changes = "");

/// `who` and `role` of what the server does by itself, as scoring a trial; and what it does then.
inline constexpr const char* kServer = "server";
inline constexpr const char* kServerWork = "serverWork";
inline constexpr const char* kBeginCoverage = "beginCoverage";
inline constexpr const char* kGoOnCoverage = "goOnCoverage";

/// HMAC-SHA-256 over the fields, each with its length before it, as hexadecimal digits.
std::string keyed_hash(const AuditKey& key, const std::vector<std::string>& fields);

/// The newest row: its number (0: none yet) and hash.
struct ChainEnd {
  std::int64_t number = 0;
  std::string hash = {};
};
core::Result<ChainEnd> chain_end(Reading& tx);

/// Recomputes the whole chain, in pieces. `seen` (if given) gets every row's number and stored
/// hash. Errors: corrupt, with the number of the first row that does not hold.
core::Result<ChainEnd> verify_chain(Reading& tx, const AuditKey& key,
                                    const std::function<void(const AuditRow&)>& seen = {});

}  // namespace tractus::store
