#include "db/store/studies/series.hpp"

#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

constexpr std::size_t kShown = 32;  ///< characters of a foreign id in an error

/// Errors: not_found where there is no row of this id and kind.
core::Result<void> check_kind(Reading& tx, const std::string& id, SeriesKind kind) {
  auto rows =
      TRY(tx.query("select 1 from studies where id = ? and kind = ?", {id, name_value(kind)}));
  if (!rows.empty()) return {};
  return core::Error{core::Errc::not_found,
                     "no " + std::string(core::name(kind)) + " " + id.substr(0, kShown)};
}

}  // namespace

core::Result<StudyId> find_study(Reading& tx, const std::string& id) {
  TRY(check_kind(tx, id, SeriesKind::study));
  return StudyId(id);
}

core::Result<AssignmentId> find_assignment(Reading& tx, const std::string& id) {
  TRY(check_kind(tx, id, SeriesKind::assignment));
  return AssignmentId(id);
}

core::Result<bool> series_exists(Reading& tx, const std::string& id) {
  auto rows = TRY(tx.query("select 1 from studies where id = ?", {id}));
  return !rows.empty();
}

core::Result<std::string> series_title(Reading& tx, const std::string& id) {
  auto rows = TRY(tx.query("select title from studies where id = ?", {id}));
  return rows.empty() ? std::string() : rows.front().text(0);
}

}  // namespace store
}  // namespace tractus
