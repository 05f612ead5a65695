#include "db/store/finding/list.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMaxCursor_bytes = 4000, kMaxKeys = 200;
constexpr const char* kUp = "up";
constexpr const char* kDown = "down";
constexpr const char* kNext = "next";
constexpr const char* kPrevious = "previous";

/// The order of a request, and the row behind (or before) which its page begins.
struct Start {
  const ListOrder* order = nullptr;
  bool descending = false;
  bool backwards = false;     ///< the page ends before the row
  std::vector<Value> behind;  ///< its sort values; empty: the page is the first
  /// The direction in which the database walks.
  bool falls() const { return descending != backwards; }
};

std::string words_of(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

Error unknown(const std::string& what, const std::vector<std::string>& allowed) {
  return {Errc::bad_input, fmt::format("{}: {} is expected", what, words_of(allowed))};
}

Result<const ListOrder*> order_named(const ListShape& shape, const std::string& name) {
  std::vector<std::string> names;
  for (const ListOrder& order : shape.orders) {
    if (order.name == name || name.empty()) return &order;
    names.push_back(order.name);
  }
  return unknown("sort", names);
}

Json value_json(const Value& value) {
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return *whole;
  if (const auto* real = std::get_if<double>(&value)) return *real;
  return std::get<std::string>(value);
}

std::optional<Value> value_from(const Json& json, ColumnType type) {
  switch (type) {
    case ColumnType::integer:
      if (json.is_number_integer() &&
          !(json.is_number_unsigned() && json.get<std::uint64_t>() > INT64_MAX))
        return Value(json.get<std::int64_t>());
      return std::nullopt;
    case ColumnType::number:
      return json.is_number() ? std::optional(Value(json.get<double>())) : std::nullopt;
    case ColumnType::text:
      return json.is_string() ? std::optional(Value(json.get<std::string>())) : std::nullopt;
  }
  return std::nullopt;
}

std::string cursor_of(const Start& start, const char* way, const std::vector<Value>& values) {
  Json out = Json::array({start.order->name, start.descending ? kDown : kUp, way});
  for (const Value& value : values) out.push_back(value_json(value));
  return core::base64url(core::bytes_of(out.dump()));
}

/// The sort values of a cursor; nothing for a text that is no cursor of this order.
std::optional<Start> start_from(const std::string& cursor, Start start) {
  constexpr std::size_t kHead = 3;
  const auto bytes = core::base64url_decoded(cursor);
  if (cursor.size() > kMaxCursor_bytes || !bytes) return std::nullopt;
  const auto json = core::parse_json(core::text_of(*bytes), "cursor");
  const auto& columns = start.order->columns;
  if (!json || !json->is_array() || json->size() != kHead + columns.size()) return std::nullopt;
  const Json &name = (*json)[0], &direction = (*json)[1], &way = (*json)[2];
  if (name != start.order->name || direction != (start.descending ? kDown : kUp))
    return std::nullopt;
  if (way != kNext && way != kPrevious) return std::nullopt;
  start.backwards = way == kPrevious;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto value = value_from((*json)[kHead + i], columns[i].type);
    if (!value) return std::nullopt;
    start.behind.push_back(std::move(*value));
  }
  return start;
}

Result<Start> start_of(const ListShape& shape, const ListRequest& request) {
  Start start;
  start.order = TRY(order_named(shape, request.sort));
  start.descending = request.descending.value_or(start.order->descending);
  if (request.cursor.empty()) return start;
  auto found = start_from(request.cursor, start);
  if (!found)
    return Error{
        Errc::bad_input,
        "cursor: it is not one of this list in this order; leave it out for the first page"};
  return std::move(*found);
}

/// " and …" for the filters that are asked for.
Result<std::string> filters_sql(const ListShape& shape, const ListRequest& request) {
  std::string out;
  for (const auto& [name, word] : request.filters) {
    const auto filter = std::ranges::find(shape.filters, name, &ListFilter::name);
    std::vector<std::string> names;
    if (filter == shape.filters.end()) {
      for (const ListFilter& known : shape.filters) names.push_back(known.name);
      return unknown(name.substr(0, 64) + ": this filter is unknown", names);
    }
    const auto choice = std::ranges::find(filter->choices, word, &ListChoice::word);
    if (choice == filter->choices.end()) {
      for (const ListChoice& known : filter->choices) names.push_back(known.word);
      return unknown(name, names);
    }
    out += " and " + choice->sql;
  }
  return out;
}

/// What `like` takes for a text in which % and _ are themselves; A to Z as small letters.
std::string pattern_of(const std::string& text) {
  std::string out = "%";
  for (const char c : text) {
    if (c == '%' || c == '_' || c == '!') out += '!';
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  }
  return out + '%';
}

/// SQLite's `like` takes A to Z as a to z of itself.
std::string search_sql(const ListShape& shape, const std::string& text,
                       std::vector<Value>& values) {
  if (text.empty()) return "";
  values.emplace_back(pattern_of(text));
  return " and /*pg: lower*/((" + shape.searched + ") /*pg: collate \"C\"*/) like ? escape '!'";
}

/// "a, b" of the order's columns, or "k0, k1" where they have been selected.
enum class Named { by_table, by_number };
std::string columns_sql(const ListOrder& order, Named named, const char* behind_each = "") {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < order.columns.size(); ++i)
    out.push_back((named == Named::by_table ? order.columns[i].sql : fmt::format("k{}", i)) +
                  behind_each);
  return words_of(out);
}

std::string selected_sql(const ListOrder& order) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < order.columns.size(); ++i)
    out.push_back(fmt::format("{} as k{}", order.columns[i].sql, i));
  return words_of(out);
}

/// "(a, b) > (?, ?)"; "1 = 1" for the first page.
std::string behind_sql(const Start& start, Named named, std::vector<Value>& values) {
  if (start.behind.empty()) return "1 = 1";
  values.insert(values.end(), start.behind.begin(), start.behind.end());
  const std::vector<std::string> places(start.behind.size(), "?");
  return fmt::format("({}) {} ({})", columns_sql(*start.order, named), start.falls() ? "<" : ">",
                     words_of(places));
}

std::string order_sql(const Start& start, Named named) {
  return " order by " + columns_sql(*start.order, named, start.falls() ? " desc" : " asc");
}

struct Asked {
  const ListShape& shape;
  const ListRequest& request;
  const Reach& reach;
  Start start;
  std::string filters = {};
};

/// " from … where …"
std::string from_sql(const Asked& asked, const std::string& reach, std::vector<Value>& values) {
  values.insert(values.end(), asked.reach.values.begin(), asked.reach.values.end());
  return " from " + asked.shape.from + " where 1 = 1" + reach + asked.filters +
         search_sql(asked.shape, asked.request.search, values);
}

/// Columns: the number of rows that match, at most one more than are gathered; then the sort values of the page's rows, which are
/// right if the number is at most kCounted. A single row of nulls stands for an empty page. There is a row more than the
/// page has if the list goes on.
Result<Rows> counted_page(Reading& tx, const Asked& asked) {
  std::vector<Value> values;
  std::string sql = "with hits as materialized (select " + selected_sql(*asked.start.order) +
                    from_sql(asked, asked.reach.sql, values) + " limit ?)";
  values.emplace_back(asked.shape.gathered + 1);
  sql += " select c.n, " + columns_sql(*asked.start.order, Named::by_number) +
         " from (select count(*) as n from hits) c left join (select * from hits where ";
  sql += behind_sql(asked.start, Named::by_number, values);
  const std::string ordered = order_sql(asked.start, Named::by_number);
  values.emplace_back(asked.request.limit + 1);
  return tx.query_with(sql + ordered + " limit ?) h on 1 = 1" + ordered, values);
}

/// Columns: 0, then the sort values of the page's rows.
Result<Rows> walked_page(Reading& tx, const Asked& asked) {
  std::vector<Value> values;
  std::string sql =
      "select 0, " + selected_sql(*asked.start.order) + from_sql(asked, asked.reach.walked, values);
  sql += " and " + behind_sql(asked.start, Named::by_table, values);
  values.emplace_back(asked.request.limit + 1);
  return tx.query_with(sql + order_sql(asked.start, Named::by_table) + " limit ?", values);
}

/// Sort values of the rows of a page, in its order, from rows that hold one more if there is more.
std::vector<std::vector<Value>> values_from(const Rows& rows, const Start& start,
                                            std::int64_t limit) {
  std::vector<std::vector<Value>> out;
  for (const Row& row : rows) {
    if (std::ssize(out) == limit || std::holds_alternative<std::monostate>(row.value(1))) break;
    std::vector<Value> values;
    for (std::size_t i = 1; i < row.size(); ++i) values.push_back(row.value(i));
    out.push_back(std::move(values));
  }
  if (start.backwards) std::ranges::reverse(out);
  return out;
}

}  // namespace

Result<FoundKeys> find_keys(Reading& tx, const ListShape& shape, const ListRequest& request,
                            const Reach& reach) {
  Asked asked{shape, request, reach, TRY(start_of(shape, request))};
  asked.filters = TRY(filters_sql(shape, request));
  Rows rows = TRY(counted_page(tx, asked));
  FoundKeys out;
  out.page.total = std::min(rows.front().integer(0), ListPage::kCounted);
  out.page.more_than_total = rows.front().integer(0) > ListPage::kCounted;
  if (rows.front().integer(0) > shape.gathered) rows = TRY(walked_page(tx, asked));
  const auto page = values_from(rows, asked.start, request.limit);
  for (const auto& values : page) out.keys.push_back(values.back());
  if (page.empty()) return out;
  const bool more = std::ssize(rows) > request.limit, turned = !asked.start.behind.empty();
  if (asked.start.backwards ? turned : more)
    out.page.next = cursor_of(asked.start, kNext, page.back());
  if (asked.start.backwards ? more : turned)
    out.page.previous = cursor_of(asked.start, kPrevious, page.front());
  return out;
}

Result<Rows> rows_of_keys(Reading& tx, const SqlPart& select, const std::vector<Value>& keys,
                          const SqlPart& tail) {
  if (keys.empty()) return Rows();
  // Few lengths: a connection keeps every statement that it has prepared.
  const std::size_t places_count = keys.size() <= 10 ? 10 : keys.size() <= 50 ? 50 : kMaxKeys;
  core::require(keys.size() <= places_count, "a page has at most 200 rows");
  std::vector<Value> values = select.values;
  values.insert(values.end(), keys.begin(), keys.end());
  values.insert(values.end(), places_count - keys.size(), keys.back());
  values.insert(values.end(), tail.values.begin(), tail.values.end());
  const std::vector<std::string> places(places_count, "?");
  const Rows found =
      TRY(tx.query_with(select.sql + " (" + words_of(places) + ")" + tail.sql, values));
  std::map<Value, const Row*> by_key;
  for (const Row& row : found) by_key.emplace(row.value(0), &row);
  Rows out;
  for (const Value& key : keys)
    if (const auto at = by_key.find(key); at != by_key.end()) out.push_back(*at->second);
  return out;
}

}  // namespace store
}  // namespace tractus
