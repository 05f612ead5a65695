#include "assessment/rubric.hpp"

#include <fmt/format.h>

#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

constexpr const char* kRubricFormat = "tractus-rubric/1";
constexpr std::size_t kMostItems = 30, kLongestLabel = 100, kLongestText = 500;
constexpr long kLargestPoint = 10;

bool is_blank(const std::string& text) {
  return text.find_first_not_of(" \t\r\n") == std::string::npos;
}

/// A text that says something.
std::string words_field(core::Fields& fields, const char* key, std::size_t limit) {
  std::string out = fields.text(key, limit);
  if (is_blank(out)) fields.wrong(key, "a text is expected");
  return out;
}

core::Result<RubricItem> item_from(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  RubricItem out;
  out.label = words_field(fields, "label", kLongestLabel);
  out.text = fields.text_or("text", "", kLongestText);
  out.low = int(fields.integer_or("low", 1, 0, kLargestPoint));
  out.high = int(fields.integer_or("high", 5, 0, kLargestPoint));
  if (out.high <= out.low) fields.wrong("high", "more than the low end of the scale is expected");
  out.low_text = words_field(fields, "low_text", kLongestText);
  out.middle_text = fields.text_or("middle_text", "", kLongestText);
  out.high_text = words_field(fields, "high_text", kLongestText);
  TRY(fields.done());
  return out;
}

Json json_of(const RubricItem& of) {
  return {{"label", of.label},        {"text", of.text},         {"low", of.low},
          {"high", of.high},          {"low_text", of.low_text}, {"middle_text", of.middle_text},
          {"high_text", of.high_text}};
}

}  // namespace

core::Result<Rubric> Rubric::from_json(const Json& json, const std::string& where) {
  core::Fields fields(json, where);
  if (fields.text("format", 64) != kRubricFormat)
    fields.wrong("format", std::string(kRubricFormat) + " is expected");
  Rubric out;
  out.title = words_field(fields, "title", kLongestLabel);
  const Json* list = fields.member("items");
  if (list && (!list->is_array() || list->empty() || list->size() > kMostItems))
    fields.wrong("items", fmt::format("an array of 1 to {} items is expected", kMostItems));
  TRY(fields.done());
  for (const Json& one : *list) {
    auto item = TRY(item_from(one, fmt::format("{}/items/{}", where, out.items.size())));
    out.items.push_back(std::move(item));
  }
  return out;
}

Json Rubric::to_json() const {
  Json list = Json::array();
  for (const RubricItem& item : items) list.push_back(json_of(item));
  return {{"format", kRubricFormat}, {"title", title}, {"items", std::move(list)}};
}

core::Result<void> Rubric::check(std::span<const int> scores, const std::string& where) const {
  if (scores.size() != items.size())
    return core::bad_input(fmt::format("{}: {} scores, one for each item, are expected, not {}",
                                       where, items.size(), scores.size()));
  for (std::size_t i = 0; i < items.size(); ++i)
    if (scores[i] < items[i].low || scores[i] > items[i].high)
      return core::bad_input(fmt::format("{}/{}: {} is outside {} to {}, the scale of '{}'", where,
                                         i, scores[i], items[i].low, items[i].high,
                                         items[i].label));
  return {};
}

}  // namespace assessment
}  // namespace tractus
