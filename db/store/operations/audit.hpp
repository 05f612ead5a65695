/// The audit trail: who changed what and when, in a hash chain that makes tampering detectable.
///
/// The hash of a row is HMAC-SHA-256 (RFC 2104) over the hash of the previous row and every field
/// of the row, each preceded by its length, with a key that is not in the database. An attacker
/// with write access only to the database therefore cannot alter, remove, insert or reorder rows
/// undetected. The chain alone does not show that its newest rows were removed: therefore its end
/// is regularly stored outside the database (ChainEnd) and compared.
#pragma once

#include <functional>
#include <vector>

#include "db/store/finding/list.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

/// An action and its actor. Its row is written in the same transaction as the first change of the
/// action, so that there is no change without a row and no row without a change.
struct AuditedAction {
  std::string who = {};       ///< name of the account or the station; "command line: USER"
  std::string role = {};      ///< name of the api::Role, or "command line"
  std::string peer = {};      ///< network address of the request; empty: this machine
  std::string what = {};      ///< id of the route, or name of the command
  std::string object = {};    ///< arguments in the path
  std::string detail = "{}";  ///< JSON; never contains a password or a code
  std::int64_t at_utc_us = 0;
};

/// During its lifetime, the first successful write of this thread is recorded as this action.
class AuditScope {
 public:
  explicit AuditScope(AuditedAction act);
  ~AuditScope();
  AuditScope(const AuditScope&) = delete;
  AuditScope& operator=(const AuditScope&) = delete;
  /// Sets the actor once it is known, during sign-in.
  static void is_by(const std::string& who, std::string_view role);
  /// Records no details of the request, which may contain a secret in the wrong field.
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

/// The list of the trail's rows (finding/list.hpp): its orders and filters.
const ListShape& audit_list();
struct FoundAudit {
  std::vector<AuditRow> rows;
  ListPage page;
};
core::Result<FoundAudit> find_audit(Reading& tx, const ListRequest& request);
/// Rows before `number`, newest first; at most `limit`.
core::Result<std::vector<AuditRow>> audit_before(Reading& tx, std::int64_t number,
                                                 std::int64_t limit);
/// Writes an action into the trail; an action without changes, for example a refusal, has no
/// `changes`.
core::Result<void> add_act(Writing& tx, const AuditKey& key, const AuditedAction& act,
                           const std::string& changes = "");

/// `who` and `role` for actions of the server itself, for example scoring a trial; and their names.
inline constexpr const char* kServer = "server";
inline constexpr const char* kCommandLine = "command line";
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

/// Recomputes the whole chain, in pieces. `seen` (if given) is called with every row. Errors:
/// corrupt, with the number of the first invalid row.
core::Result<ChainEnd> verify_chain(Reading& tx, const AuditKey& key,
                                    const std::function<void(const AuditRow&)>& seen = {});

}  // namespace tractus::store
