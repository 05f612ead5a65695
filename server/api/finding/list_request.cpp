#include "server/api/finding/list_request.hpp"

#include <fmt/format.h>

#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::size_t kMaxSearch_bytes = 200;
constexpr double kMostRows = 200;

enum class Direction { ascending, descending };
constexpr auto words(Direction) {
  using enum Direction;
  return std::to_array<core::Word<Direction>>(
      {{ascending, "ascending"}, {descending, "descending"}});
}

Parameter list_text(std::string name, std::string meaning, std::vector<std::string> values = {}) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .required = false,
          .values = std::move(values)};
}

}  // namespace

std::vector<Parameter> list_parameters(const store::ListShape& shape, const std::string& searched) {
  std::vector<std::string> sorts;
  for (const auto& order : shape.orders) sorts.push_back(order.name);
  const std::string first = sorts.front();
  std::vector<Parameter> out{
      list_text("search", fmt::format("Only rows with this text in {}, without regard to the case "
                                      "of the letters A to Z; at most {} bytes",
                                      searched, kMaxSearch_bytes)),
      list_text("sort", "Order of the rows; without it: " + first, std::move(sorts)),
      list_text("order", "Direction; without it the usual one of the order",
                core::names<Direction>()),
      list_text("cursor",
                "Cursor of a page, from the fields next and previous of an answer with the same "
                "search, filters and order; without it: the first page"),
      {.in = Parameter::In::query,
       .name = "limit",
       .kind = Parameter::Kind::integer,
       .unit = "1",
       .meaning = "Largest number of rows in the answer",
       .low = 1,
       .high = kMostRows,
       .fallback = "50"}};
  for (const auto& filter : shape.filters) {
    std::vector<std::string> choices;
    for (const auto& choice : filter.choices) choices.push_back(choice.word);
    out.push_back(list_text(filter.name, filter.meaning, std::move(choices)));
  }
  return out;
}

core::Result<store::ListRequest> list_request(const Call& call, const store::ListShape& shape) {
  const auto text = [&](const char* name) { return call.has(name) ? call.text(name) : ""; };
  store::ListRequest out{.search = text("search"),
                         .sort = text("sort"),
                         .cursor = text("cursor"),
                         .limit = call.integer("limit")};
  if (out.search.size() > kMaxSearch_bytes || !store::is_text(out.search))
    return core::Error{
        core::Errc::bad_input,
        fmt::format("search: at most {} bytes of text are expected", kMaxSearch_bytes)};
  if (call.has("order"))
    out.descending = core::from_name<Direction>(call.text("order")) == Direction::descending;
  for (const auto& filter : shape.filters)
    if (call.has(filter.name)) out.filters.emplace(filter.name, call.text(filter.name));
  return out;
}

std::vector<schema::Field> page_fields() {
  using namespace schema;
  return {{"total", integer("1", fmt::format("Number of rows that match, of all pages; at most {}",
                                             store::ListPage::kCounted))},
          {"more_than_total", truth("True if more rows match than `total` says")},
          {"next", nullable(text("Cursor of the next page; null if this page is the last one"))},
          {"previous",
           nullable(text("Cursor of the page before; null if this page is the first one"))}};
}

core::Json with_page(core::Json answer, const store::ListPage& page) {
  answer["total"] = page.total;
  answer["more_than_total"] = page.more_than_total;
  answer["next"] = core::or_null(page.next);
  answer["previous"] = core::or_null(page.previous);
  return answer;
}

}  // namespace api
}  // namespace tractus
