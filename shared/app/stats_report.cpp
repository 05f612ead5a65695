#include "app/stats_report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace commands {
namespace {

using core::Json;

constexpr std::size_t kShownRows = 40;

std::string cell(const Json& value) {
  if (value.is_null()) return "-";
  if (value.is_number_integer()) return fmt::format("{}", value.get<long>());
  if (value.is_number()) {
    const double number = value.get<double>();
    if (number != number) return "-";
    return fmt::format("{:.6g}", number);
  }
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string table_text(const std::string& title, const Json& rows) {
  std::vector<std::string> keys;
  for (const auto& [key, _] : rows[0].items()) keys.push_back(key);
  const std::size_t shown = std::min(rows.size(), kShownRows);
  std::string out = "\n" + title + "\n";
  std::vector<std::size_t> widths;
  for (const auto& key : keys) {
    std::size_t width = key.size();
    for (std::size_t i = 0; i < shown; ++i) width = std::max(width, cell(rows[i][key]).size());
    widths.push_back(width);
  }
  const auto line = [&](const std::function<std::string(const std::string&)>& text_of) {
    for (std::size_t j = 0; j < keys.size(); ++j)
      out += j == 0 ? fmt::format("  {:<{}}", text_of(keys[j]), widths[j])
                    : fmt::format("  {:>{}}", text_of(keys[j]), widths[j]);
    out += "\n";
  };
  line([](const std::string& key) { return key; });
  for (std::size_t i = 0; i < shown; ++i)
    line([&](const std::string& key) { return cell(rows[i][key]); });
  if (shown < rows.size()) out += fmt::format("  … and {} more (--json)\n", rows.size() - shown);
  return out;
}

std::string block_text(const std::string& title, const Json& block) {
  std::string out = "\n" + title + "\n";
  for (const auto& [key, value] : block.items())
    out += fmt::format("  {:<28}{}\n", key, cell(value));
  return out;
}

}  // namespace

Json report_head(const Analysis& of, const char* method) {
  return {{"method", method},
          {"file", of.table.name()},
          {"formula", of.formula_text},
          {"rows", of.table.rows()},
          {"rows_left_out", of.table.dropped()}};
}

Json coefficient_table(
    const std::vector<std::string>& names,
    const std::vector<std::pair<const char*, const statistics::Vector*>>& columns) {
  Json out = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    Json row = {{"name", names[i]}};
    for (const auto& [key, values] : columns) row[key] = (*values)[static_cast<Eigen::Index>(i)];
    out.push_back(std::move(row));
  }
  return out;
}

std::string printed(const Json& report) {
  std::string out = fmt::format("{}: {}\n{}, {} rows", report["method"].get<std::string>(),
                                report["formula"].get<std::string>(),
                                report["file"].get<std::string>(), report["rows"].get<long>());
  if (const long dropped = report["rows_left_out"].get<long>(); dropped > 0)
    out += fmt::format(", {} left out for missing values", dropped);
  out += "\n";
  for (const auto& [key, value] : report.items()) {
    std::string title = key;
    std::ranges::replace(title, '_', ' ');
    if (key == "notes") continue;
    if (value.is_object()) out += block_text(title, value);
    if (value.is_array() && !value.empty()) out += table_text(title, value);
  }
  if (!report.contains("notes")) return out;
  for (const auto& note : report["notes"]) out += "\nNote: " + note.get<std::string>() + "\n";
  return out;
}

}  // namespace commands
