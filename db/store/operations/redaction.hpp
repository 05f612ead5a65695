/// People taken out of the audit trail without breaking its chain.
///
/// A row keeps its number, its time and its stored hash, which the next row's hash covers. What it says is replaced where it names
/// the person, and a digest under the trail's key of what it says now stands in the table `redactions`, which the trail covers
/// (coverage.hpp): whoever edits such a row is seen as with every other row.
#pragma once

#include "db/store/operations/audit.hpp"

namespace tractus::store {

/// Whether the row says what it said after persons were taken out of it the last time; false for a row of which nobody was.
core::Result<bool> is_redacted(Reading& tx, const AuditKey& key, const AuditRow& row);

struct NamedPerson {
  std::string name;
  std::string badge;  ///< empty: none
  std::string alias;  ///< stands in their place
};
/// The row without the person: as actor, in the object, in the fields of the detail that name people or hold free text, and in the
/// keys of changed rows.
AuditRow without_person(AuditRow row, const NamedPerson& person);

/// Number of rows of the trail that name the person.
core::Result<std::uint64_t> rows_naming(Reading& tx, const NamedPerson& person);
/// Takes the person out of the whole trail, some hundred rows a transaction. Right again after an interruption.
core::Result<void> redact_person(Store& store, const NamedPerson& person);
/// Takes the network addresses of successful sign-ins before a time out of the trail. Returns the number of rows that it changed.
core::Result<std::uint64_t> redact_sign_ins(Store& store, std::int64_t before_utc_us);

}  // namespace tractus::store
