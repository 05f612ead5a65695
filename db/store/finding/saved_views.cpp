#include "db/store/finding/saved_views.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

core::Result<SavedView> view_from(const Row& row) {
  const auto page = TRY(row.word<ListedPage>(2, "saved_views.page"));
  return SavedView{row.text(0), row.text(1), page, row.text(3), row.text(4), row.integer(5)};
}

}  // namespace

core::Result<void> save_view(Writing& tx, const SavedView& view) {
  TRY(tx.query(
      "insert into saved_views (id, account_id, page, name, search, made_utc_us) values (?, ?, ?, "
      "?, ?, ?) on conflict (account_id, page, name) do update set search = ?, made_utc_us = ?",
      {view.id, view.account_id, name_value(view.page), view.name, view.search, view.made_utc_us,
       view.search, view.made_utc_us}));
  const auto rows =
      TRY(tx.query("select count(*) from saved_views where account_id = ?", {view.account_id}));
  if (rows.front().integer(0) <= kMaxViews) return {};
  return core::Error{core::Errc::conflict,
                     fmt::format("there are {} saved views already: remove one first", kMaxViews)};
}

core::Result<std::vector<SavedView>> saved_views_of(Reading& tx, const std::string& account_id) {
  return all_of(tx.query("select id, account_id, page, name, search, made_utc_us from saved_views "
                         "where account_id = ? order by page, name",
                         {account_id}),
                view_from);
}

core::Result<void> remove_view(Writing& tx, const std::string& account_id, const std::string& id) {
  const auto rows = TRY(tx.query(
      "delete from saved_views where id = ? and account_id = ? returning id", {id, account_id}));
  if (!rows.empty()) return {};
  return core::Error{core::Errc::not_found, "no saved view " + id.substr(0, 32)};
}

}  // namespace store
}  // namespace tractus
