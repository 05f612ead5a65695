#include "app/stats_formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

namespace commands {
namespace {

constexpr std::size_t kMostLevels = 200;

core::Error wrong(std::string what) { return {core::Errc::bad_input, std::move(what)}; }

/// Reads a formula left to right; the first thing wrong stays.
class Reader {
 public:
  explicit Reader(const std::string& text) : text_(text) {}

  bool take(char expected) {
    skip();
    if (at_ >= text_.size() || text_[at_] != expected) return false;
    ++at_;
    return true;
  }
  void need(char expected) {
    if (!take(expected)) fail(fmt::format("'{}' is expected", expected));
  }
  /// A bare name, or anything between backticks.
  std::string word() {
    skip();
    const std::size_t start = at_;
    if (take('`')) {
      const auto end = text_.find('`', at_);
      if (end == std::string::npos) return fail("a backtick stays open"), "";
      const auto name = text_.substr(at_, end - at_);
      at_ = end + 1;
      return name;
    }
    while (at_ < text_.size() && is_part(text_[at_])) ++at_;
    if (at_ == start) fail("a column's name is expected");
    return text_.substr(start, at_ - start);
  }
  bool at_end() {
    skip();
    return at_ >= text_.size();
  }
  void fail(const std::string& why) {
    if (!error_.empty()) return;
    error_ = fmt::format("--formula '{}', at character {}: {}", text_, at_ + 1, why);
  }
  const std::string& error() const { return error_; }

 private:
  static bool is_part(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' ||
           static_cast<unsigned char>(c) >= 128;
  }
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  const std::string& text_;
  std::size_t at_ = 0;
  std::string error_;
};

bool as_number(const std::string& text, double& value) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc() && end.ptr == text.data() + text.size();
}

void read_response(Reader& in, Formula& out) {
  out.response = in.word();
  if (in.take('/')) {
    out.trials = in.word();
    if (as_number(out.trials, out.trials_number)) out.trials.clear();
  }
  in.need('~');
}

void read_term(Reader& in, Formula& out) {
  if (in.take('(')) {
    if (in.word() != "1") in.fail("only a random intercept, (1|group), can stand in brackets");
    in.need('|');
    if (!out.group.empty()) in.fail("one random intercept is all that is possible");
    out.group = in.word();
    return in.need(')');
  }
  const std::string word = in.word();
  if (word == "0" || word == "1") {
    out.intercept = word == "1";
    return;
  }
  Term term{word, false};
  if (word == "factor" && in.take('(')) {
    term = {in.word(), true};
    in.need(')');
  }
  double number = 0.0;
  if (as_number(term.column, number)) in.fail("a number other than 0 and 1 is no term");
  if (std::ranges::any_of(out.terms, [&](const Term& t) { return t.column == term.column; }))
    in.fail(fmt::format("'{}' stands there twice", term.column));
  out.terms.push_back(term);
}

core::Result<void> add_factor(const Table& table, const std::string& column, bool all_levels,
                              std::vector<statistics::Vector>& columns,
                              std::vector<std::string>& names) {
  const auto levels = levels_of(table, column);
  if (levels.size() < 2)
    return wrong(fmt::format("{}: column '{}' is '{}' in every row: there is nothing to compare",
                             table.name(), column, levels[0]));
  if (levels.size() > kMostLevels)
    return wrong(
        fmt::format("{}: column '{}' is text with {} different values: too many for a "
                    "factor (at most {}); is it a number misread?",
                    table.name(), column, levels.size(), kMostLevels));
  const auto& cells = table.texts(column);
  for (std::size_t level = all_levels ? 0 : 1; level < levels.size(); ++level) {
    statistics::Vector mark(static_cast<Eigen::Index>(cells.size()));
    for (std::size_t i = 0; i < cells.size(); ++i)
      mark[static_cast<Eigen::Index>(i)] = cells[i] == levels[level] ? 1.0 : 0.0;
    columns.push_back(std::move(mark));
    names.push_back(fmt::format("{}[{}]", column, levels[level]));
  }
  return {};
}

}  // namespace

std::vector<std::string> Formula::columns() const {
  std::vector<std::string> out{response};
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::ranges::find(out, name) == out.end()) out.push_back(name);
  };
  add(trials);
  for (const auto& term : terms) add(term.column);
  add(group);
  return out;
}

core::Result<Formula> parse_formula(const std::string& text) {
  Formula out;
  Reader in(text);
  read_response(in, out);
  do {
    read_term(in, out);
  } while (in.error().empty() && in.take('+'));
  if (!in.at_end()) in.fail("'+' or the end is expected");
  if (!in.error().empty()) return wrong(in.error());
  for (const auto& term : out.terms)
    if (term.column == out.response || term.column == out.trials)
      return wrong(fmt::format("--formula '{}': '{}' stands on both sides", text, term.column));
  return out;
}

std::vector<std::string> levels_of(const Table& table, const std::string& column) {
  const auto& cells = table.texts(column);
  const std::set<std::string_view> found(cells.begin(), cells.end());
  std::vector<std::string> out(found.begin(), found.end());
  if (table.is_numeric(column))
    std::ranges::sort(out, {},
                      [](const std::string& s) { return std::strtod(s.c_str(), nullptr); });
  return out;
}

core::Result<statistics::Design> design_of(const Formula& formula, const Table& table) {
  std::vector<statistics::Vector> columns;
  statistics::Design out;
  const auto rows = static_cast<Eigen::Index>(table.rows());
  out.intercept = formula.intercept;
  if (formula.intercept) {
    columns.push_back(statistics::Vector::Ones(rows));
    out.names.push_back("(Intercept)");
  }
  // Without an intercept the first factor gets a column for every level, as a cell mean.
  bool cell_means = !formula.intercept;
  for (const auto& term : formula.terms) {
    if (term.factor || !table.is_numeric(term.column)) {
      if (auto added = add_factor(table, term.column, cell_means, columns, out.names); !added)
        return added.error();
      cell_means = false;
      continue;
    }
    auto numbers = table.numbers(term.column);
    if (!numbers) return numbers.error();
    columns.push_back(std::move(*numbers));
    out.names.push_back(term.column);
  }
  if (columns.empty()) return wrong("the formula has no term: nothing to estimate");
  out.columns.resize(rows, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j)
    out.columns.col(static_cast<Eigen::Index>(j)) = columns[j];
  return out;
}

}  // namespace commands
