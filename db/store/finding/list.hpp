/// One page of a list: searched, filtered, sorted and cut by the database.
///
/// Each list says once what may be asked of it (ListShape). A cursor holds the sort values of a row, and a page begins
/// behind them: rows that come or go meanwhile make no other row appear twice or be left out.
///
/// A search that matches few rows reads the list once; one that matches many follows the index of its order and stops
/// when the page is full. Either way at most one row per entry of the list is read, whatever it matches.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

enum class ColumnType { integer, number, text };

/// A column that rows are sorted by; never null.
struct OrderColumn {
  std::string sql;
  ColumnType type = ColumnType::text;
};
/// An order that rows may have. The list has an index on these columns; the last one is the row's key.
struct ListOrder {
  std::string name;
  std::vector<OrderColumn> columns;
  bool descending = false;  ///< unless the request says otherwise
};
struct ListChoice {
  std::string word, sql;
};
/// A filter with a closed list of choices.
struct ListFilter {
  std::string name, meaning;
  std::vector<ListChoice> choices;
};
/// A choice for each word of an enum that a column holds.
template <core::Named E>
std::vector<ListChoice> choices_of(const std::string& column) {
  std::vector<ListChoice> out;
  for (const std::string& word : core::names<E>())
    out.push_back({word, column + " = '" + word + "'"});
  return out;
}
struct ListShape {
  std::string from;               ///< "trial_entries e"
  std::string searched;           ///< an expression for the text in which a search looks
  std::vector<ListOrder> orders;  ///< the first is that of a request without one
  std::vector<ListFilter> filters;
  std::int64_t gathered =
      10'000;  ///< so many matching rows are sorted; among more, an index is followed
};

/// What is asked of a list. Words that the shape does not have are an error of the caller's input.
struct ListRequest {
  std::string search =
      {};                 ///< in the list's text, without regard to the case of the letters A to Z
  std::string sort = {};  ///< name of the order; empty: the first
  std::optional<bool> descending = {};
  std::map<std::string, std::string> filters = {};  ///< name and choice
  std::string cursor = {};  ///< of a page before or behind this one; empty: the first page
  std::int64_t limit = 50;
};

/// Which rows a list may hold at all: " and …" with its values. `walked` means the same, in words that keep a database
/// from using an index for it: the order's index is used instead.
struct Reach {
  std::string sql = {}, walked = {};
  std::vector<Value> values = {};
};

/// Where a page is in its list.
struct ListPage {
  static constexpr std::int64_t kCounted = 1000;  ///< more rows than this are not counted
  std::int64_t total = 0;                         ///< rows that match, at most kCounted
  bool more_than_total = false;
  std::string next = {}, previous = {};  ///< cursors; empty: there is no such page
};
struct FoundKeys {
  std::vector<Value> keys;  ///< of the page's rows, in its order
  ListPage page;
};

/// Errors: bad_input for a word that the shape does not have, a cursor of another order, or a search that is not text.
core::Result<FoundKeys> find_keys(Reading& tx, const ListShape& shape, const ListRequest& request,
                                  const Reach& reach = {});

/// A part of a statement with its values.
struct SqlPart {
  std::string sql = {};
  std::vector<Value> values = {};
};
/// The rows of `select`, whose first column is the key, in the order of the keys; a key without a row is left out.
/// `select` ends where the keys follow: "… where t.id in"; `tail` stands behind them.
core::Result<Rows> rows_of_keys(Reading& tx, const SqlPart& select, const std::vector<Value>& keys,
                                const SqlPart& tail = {});

}  // namespace tractus::store
