/// Views that people saved: what a page of a list shows, by a name of their own.
#pragma once

#include "core/named.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

/// A page with a list.
enum class ListedPage { trials, assignments, accounts, audit, cases };
constexpr auto words(ListedPage) {
  using enum ListedPage;
  return std::to_array<core::Word<ListedPage>>({{trials, "trials"},
                                                {assignments, "assignments"},
                                                {accounts, "accounts"},
                                                {audit, "audit"},
                                                {cases, "cases"}});
}

struct SavedView {
  std::string id, account_id;
  ListedPage page = ListedPage::trials;
  std::string name;
  std::string search;  ///< the part of the page's address behind the question mark
  std::int64_t made_utc_us = 0;
};

/// Views of one account, at most.
inline constexpr std::int64_t kMaxViews = 100;

/// A view of the same page and name is replaced, and keeps its id. Errors: conflict if the account has kMaxViews.
core::Result<void> save_view(Writing& tx, const SavedView& view);
/// Of one account, by page and name.
core::Result<std::vector<SavedView>> saved_views_of(Reading& tx, const std::string& account_id);
/// Errors: not_found, also for the view of another account.
core::Result<void> remove_view(Writing& tx, const std::string& account_id, const std::string& id);

}  // namespace tractus::store
