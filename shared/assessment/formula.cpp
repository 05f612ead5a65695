#include "assessment/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace assessment {
namespace {

constexpr std::size_t kMostLevels = 200, kMostColumns = 2000, kMostTerms = 200;

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
  /// Is `c` next?
  bool sees(char c) {
    skip();
    return at_ < text_.size() && text_[at_] == c;
  }
  /// Takes exactly this word, if it is next.
  bool take_word(const std::string& word) {
    skip();
    const std::size_t end = at_ + word.size();
    if (text_.compare(at_, word.size(), word) != 0) return false;
    if (end < text_.size() && is_part(text_[end])) return false;
    at_ = end;
    last_ = word;
    return true;
  }
  const std::string& last() const { return last_; }
  bool at_end() {
    skip();
    return at_ >= text_.size();
  }
  void fail(const std::string& why) {
    if (!error_.empty()) return;
    error_ =
        fmt::format("--formula '{}', at character {}: {}", core::one_line(text_), at_ + 1, why);
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
  std::string error_, last_;
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

Variable read_variable(Reader& in) {
  const std::string word = in.word();
  double number = 0.0;
  if (as_number(word, number)) in.fail("a number other than 0 and 1 is no term");
  if (!in.take('(')) return {word};
  Variable out{in.word()};
  if (word == "factor" || word == "C") {
    out.as = Variable::As::factor;
  } else if (word == "log") {
    out.as = Variable::As::log;
  } else if (word == "I") {
    in.need('^');
    const std::string power = in.word();
    if (!as_number(power, number) || number < 2 || number > 9 || number != std::floor(number))
      in.fail("I(column^n) takes n from 2 to 9");
    out.as = Variable::As::power;
    out.exponent = static_cast<int>(number);
  } else {
    in.fail(fmt::format("'{}(' is unknown: C(), factor(), I(), log() are there", word));
  }
  in.need(')');
  return out;
}

void add_term(const Term& term, Formula& out) {
  if (std::ranges::find(out.terms, term) == out.terms.end()) out.terms.push_back(term);
}

/// a, a:b, or a*b with all that it stands for.
void read_product(Reader& in, Formula& out) {
  std::vector<Term> made{{{read_variable(in)}}};
  if (made[0].variables.size() == 1 && std::ranges::find(out.terms, made[0]) != out.terms.end() &&
      !in.sees('*') && !in.sees(':'))
    return in.fail(fmt::format("'{}' stands there twice", made[0].name()));
  while (in.error().empty()) {
    const bool crossed = in.take('*');
    if (!crossed && !in.take(':')) break;
    const Variable next = read_variable(in);
    std::vector<Term> with = made;
    for (auto& term : with) {
      if (std::ranges::find(term.variables, next) != term.variables.end())
        return in.fail(
            fmt::format("'{}' multiplies itself: write I({}^2)", next.name(), next.column));
      term.variables.push_back(next);
    }
    if (!crossed) {
      made = with;
      continue;
    }
    made.push_back({{next}});
    made.insert(made.end(), with.begin(), with.end());
    if (made.size() > kMostTerms) break;  // each '*' doubles them
  }
  for (const auto& term : made) add_term(term, out);
  if (out.terms.size() > kMostTerms)
    in.fail(fmt::format("more than {} terms: multiply fewer columns", kMostTerms));
}

/// "a", "a:b", or "a/b" for a and a:b.
std::vector<std::vector<std::string>> read_grouping(Reader& in) {
  std::vector<std::vector<std::string>> out{{in.word()}};
  while (in.error().empty()) {
    const bool nested = in.take('/');
    if (!nested && !in.take(':')) break;
    const std::string next = in.word();
    if (std::ranges::find(out.back(), next) != out.back().end())
      in.fail(fmt::format("'{}' stands there twice", next));
    auto finer = out.back();
    finer.push_back(next);
    if (nested)
      out.push_back(std::move(finer));
    else
      out.back() = std::move(finer);
  }
  return out;
}

/// After the opening bracket: (1 + x | a).
void read_random(Reader& in, Formula& out) {
  RandomEffects effects;
  effects.intercept = true;
  do {
    if (in.take_word("0") || in.take_word("1"))
      effects.intercept = in.last() == "1";
    else
      effects.slopes.push_back(in.word());
  } while (in.error().empty() && in.take('+'));
  in.need('|');
  if (!effects.intercept && effects.slopes.empty()) in.fail("(0 | …) holds no random effect");
  for (auto& columns : read_grouping(in)) {
    effects.columns = std::move(columns);
    if (std::ranges::find(out.random, effects) != out.random.end())
      in.fail(fmt::format("the random term of {} stands there twice", effects.group()));
    out.random.push_back(effects);
  }
  in.need(')');
}

/// (1|a) alone is what other methods know too.
void keep_single_intercept(Formula& out) {
  if (out.random.size() != 1) return;
  const RandomEffects& only = out.random[0];
  if (!only.intercept || !only.slopes.empty() || only.columns.size() != 1) return;
  out.group = only.columns[0];
  out.random.clear();
}

void read_term(Reader& in, Formula& out) {
  if (in.take('(')) return read_random(in, out);
  if (in.take_word("0") || in.take_word("1")) {
    out.intercept = in.last() == "1";
    return;
  }
  read_product(in, out);
}

/// The columns a variable brings: itself, or 0/1 columns of its levels.
struct Columns {
  std::vector<statistics::Vector> values;
  std::vector<std::string> names;
};

core::Result<Columns> factor_columns(const Table& table, const Variable& of, bool all_levels) {
  const auto levels = levels_of(table, of.column);
  if (levels.size() < 2)
    return core::bad_input(
        fmt::format("{}: column '{}' is '{}' in every row: there is nothing to compare",
                    table.name(), of.column, levels[0]));
  if (levels.size() > kMostLevels)
    return core::bad_input(
        fmt::format("{}: column '{}' is text with {} different values: too many for a "
                    "factor (at most {}); is it a number misread?",
                    table.name(), of.column, levels.size(), kMostLevels));
  const auto places = places_of(table, of.column, levels);
  const std::size_t first = all_levels ? 0 : 1;
  Columns out;
  out.values.assign(levels.size() - first,
                    statistics::Vector::Zero(static_cast<Eigen::Index>(places.size())));
  for (std::size_t i = 0; i < places.size(); ++i)
    if (places[i] >= first) out.values[places[i] - first][static_cast<Eigen::Index>(i)] = 1.0;
  for (std::size_t level = first; level < levels.size(); ++level)
    out.names.push_back(fmt::format("{}[{}]", of.column, levels[level]));
  return out;
}

bool is_factor(const Variable& of, const Table& table) {
  return of.as == Variable::As::factor ||
         (of.as == Variable::As::itself && !table.is_numeric(of.column));
}

core::Result<Columns> columns_of(const Table& table, const Variable& of, bool all_levels) {
  if (of.as == Variable::As::itself) TRY(table.holds_numbers(of.column));
  if (is_factor(of, table)) return factor_columns(table, of, all_levels);
  auto numbers = TRY(table.numbers(of.column));
  Columns out{{std::move(numbers)}, {of.name()}};
  auto values = out.values[0].array();
  if (of.as == Variable::As::power) values = values.pow(of.exponent).eval();
  if (of.as == Variable::As::log) {
    Eigen::Index at = 0;
    if (!(values.minCoeff(&at) > 0.0))
      return core::bad_input(fmt::format("{}:{}: column '{}' is {} and has no logarithm",
                                         table.name(), table.line(static_cast<std::size_t>(at)),
                                         of.column, values[at]));
    values = values.log().eval();
  }
  return out;
}

/// Is the term without its variable `left_out` in the model? (Nothing left: the intercept.)
bool has_without(const Formula& formula, const Term& term, std::size_t left_out) {
  Term rest = term;
  rest.variables.erase(rest.variables.begin() + static_cast<std::ptrdiff_t>(left_out));
  if (rest.variables.empty()) return formula.intercept;
  return std::ranges::find(formula.terms, rest) != formula.terms.end();
}

core::Result<Columns> term_columns(const Formula& formula, const Table& table, const Term& term,
                                   bool cell_means) {
  Columns out;
  for (std::size_t v = 0; v < term.variables.size(); ++v) {
    const bool lone = term.variables.size() == 1;
    const bool all = lone ? cell_means : !has_without(formula, term, v);
    auto next = TRY(columns_of(table, term.variables[v], all));
    if (v == 0) {
      out = std::move(next);
      continue;
    }
    Columns product;
    for (std::size_t b = 0; b < next.values.size(); ++b)
      for (std::size_t a = 0; a < out.values.size(); ++a) {
        product.values.push_back(out.values[a].cwiseProduct(next.values[b]));
        product.names.push_back(out.names[a] + ":" + next.names[b]);
      }
    out = std::move(product);
  }
  return out;
}

}  // namespace

std::string Variable::name() const {
  if (as == As::power) return fmt::format("I({}^{})", column, exponent);
  return as == As::log ? "log(" + column + ")" : column;
}

std::string Term::name() const {
  std::string out;
  for (const auto& variable : variables) out += (out.empty() ? "" : ":") + variable.name();
  return out;
}

std::string RandomEffects::group() const {
  std::string out;
  for (const auto& column : columns) out += (out.empty() ? "" : ":") + column;
  return out;
}

bool Term::contains(const Term& other) const {
  return std::ranges::all_of(other.variables, [&](const Variable& wanted) {
    return std::ranges::find(variables, wanted) != variables.end();
  });
}

std::vector<std::string> Formula::columns() const {
  std::vector<std::string> out{response};
  const auto add = [&](const std::string& name) {
    if (!name.empty() && std::ranges::find(out, name) == out.end()) out.push_back(name);
  };
  add(trials);
  for (const auto& term : terms)
    for (const auto& variable : term.variables) add(variable.column);
  add(group);
  for (const auto& effects : random) {
    for (const auto& slope : effects.slopes) add(slope);
    for (const auto& column : effects.columns) add(column);
  }
  return out;
}

std::vector<std::string> Formula::factors() const {
  std::vector<std::string> out;
  for (const auto& term : terms)
    if (term.variables.size() == 1) out.push_back(term.variables[0].column);
  return out;
}

core::Result<Formula> parse_formula(const std::string& text) {
  Formula out;
  Reader in(text);
  read_response(in, out);
  do {
    read_term(in, out);
  } while (in.error().empty() && in.take('+'));
  if (!in.at_end()) in.fail("'+', '*', ':' or the end is expected");
  if (!in.error().empty()) return core::bad_input(in.error());
  keep_single_intercept(out);
  std::ranges::stable_sort(out.terms, {}, [](const Term& t) { return t.variables.size(); });
  for (const auto& term : out.terms)
    for (const auto& variable : term.variables)
      if (variable.column == out.response || variable.column == out.trials)
        return core::bad_input(fmt::format("--formula '{}': '{}' stands on both sides",
                                           core::one_line(text), core::one_line(variable.column)));
  return out;
}

std::vector<std::string> levels_of(const Table& table, const std::string& column) {
  const auto& cells = table.texts(column);
  const std::unordered_set<std::string_view> found(cells.begin(), cells.end());
  std::vector<std::string> out(found.begin(), found.end());
  const bool numeric =
      std::ranges::all_of(out, [](const auto& cell) { return number_in(cell).has_value(); });
  if (numeric)
    std::ranges::sort(
        out, {}, [](const std::string& s) { return std::pair(number_in(s).value_or(0.0), s); });
  else
    std::ranges::sort(out);
  return out;
}

std::vector<std::size_t> places_of(const Table& table, const std::string& column,
                                   const std::vector<std::string>& levels) {
  std::unordered_map<std::string_view, std::size_t> place;
  for (std::size_t j = 0; j < levels.size(); ++j) place.emplace(levels[j], j);
  std::vector<std::size_t> out;
  out.reserve(table.rows());
  for (const auto cell : table.texts(column)) out.push_back(place.at(cell));
  return out;
}

core::Result<ModelMatrix> model_matrix(const Formula& formula, const Table& table) {
  const auto rows = static_cast<Eigen::Index>(table.rows());
  Columns all;
  ModelMatrix out;
  out.design.intercept = formula.intercept;
  if (formula.intercept) {
    all = {{statistics::Vector::Ones(rows)}, {"(Intercept)"}};
    out.term_of.push_back(-1);
  }
  // Without an intercept the first factor gets a column for every level, as a cell mean.
  bool cell_means = !formula.intercept;
  for (std::size_t t = 0; t < formula.terms.size(); ++t) {
    auto next = TRY(term_columns(formula, table, formula.terms[t], cell_means));
    if (is_factor(formula.terms[t].variables[0], table)) cell_means = false;
    if (all.values.size() + next.values.size() > kMostColumns)
      return core::bad_input(fmt::format("the formula makes over {} columns", kMostColumns));
    for (std::size_t j = 0; j < next.values.size(); ++j) {
      all.values.push_back(std::move(next.values[j]));
      all.names.push_back(std::move(next.names[j]));
      out.term_of.push_back(static_cast<int>(t));
    }
  }
  if (all.values.empty()) return core::bad_input("the formula has no term: nothing to estimate");
  out.design.names = std::move(all.names);
  out.design.columns.resize(rows, static_cast<Eigen::Index>(all.values.size()));
  for (std::size_t j = 0; j < all.values.size(); ++j)
    out.design.columns.col(static_cast<Eigen::Index>(j)) = all.values[j];
  return out;
}

}  // namespace assessment
}  // namespace tractus
