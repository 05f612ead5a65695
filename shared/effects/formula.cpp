#include "effects/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <optional>

namespace tractus {
namespace effects {
namespace {

constexpr std::size_t kLongest = 1000;
constexpr int kDeepest = 100;  // a bracket counts twice

/// What a function makes of its argument's dimension.
enum class Rule { same, root, plain, sign, several };
struct Function {
  std::string_view name;
  Rule rule;
  bool zero_at_zero;
};
constexpr std::array<Function, 17> kFunctions{{{"abs", Rule::same, true},
                                               {"sqrt", Rule::root, true},
                                               {"sign", Rule::sign, true},
                                               {"sgn", Rule::sign, true},
                                               {"min", Rule::several, true},
                                               {"max", Rule::several, true},
                                               {"exp", Rule::plain, false},
                                               {"ln", Rule::plain, false},
                                               {"sin", Rule::plain, true},
                                               {"cos", Rule::plain, false},
                                               {"tan", Rule::plain, true},
                                               {"asin", Rule::plain, true},
                                               {"acos", Rule::plain, false},
                                               {"atan", Rule::plain, true},
                                               {"sinh", Rule::plain, true},
                                               {"cosh", Rule::plain, false},
                                               {"tanh", Rule::plain, true}}};

const Dimension kSecond = *Dimension::parse("s"), kMetre = *Dimension::parse("m");

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A part of the formula, as derived.
struct Part {
  std::size_t from = 0, to = 0;     ///< its text
  Dimension dimension;              ///< of no meaning where `zero`
  std::optional<double> number;     ///< its value if it is made of numbers alone
  bool zero = false;                ///< the number 0, which fits every dimension
  std::vector<bool> vanishes = {};  ///< by quantity: surely 0 where that is 0
};

class Checker {
 public:
  Checker(std::string_view text, std::span<const Quantity> quantities)
      : text_(text), quantities_(quantities), uses_(quantities.size()) {}

  core::Result<FormulaFacts> run(const std::optional<Dimension>& expected) {
    const Part whole = choice();
    skip_spaces();
    if (error_.empty() && at_ < text_.size())
      fail(fmt::format("`{}`: an operator or the end is expected", text_.substr(at_, 20)));
    if (error_.empty() && expected && !whole.zero && whole.dimension != *expected)
      fail(fmt::format("`{}`: {} where {} is expected", text_, whole.dimension.text(),
                       expected->text()));
    if (!error_.empty()) return core::Error{core::Errc::bad_input, error_};
    return FormulaFacts{whole.dimension, uses_, whole.vanishes, std::move(memories_)};
  }

 private:
  using Rung = Part (Checker::*)();

  void fail(std::string why) {
    if (error_.empty()) error_ = std::move(why);
    at_ = text_.size();  // the rest is not looked at
  }
  void skip_spaces() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(std::string_view symbol) {
    skip_spaces();
    if (!text_.substr(at_).starts_with(symbol)) return false;
    at_ += symbol.size();
    return true;
  }
  std::string text(std::size_t from, std::size_t to) const {
    std::string_view out = text_.substr(from, to - from);
    while (out.ends_with(' ')) out.remove_suffix(1);
    return std::string(out);
  }
  std::string text(const Part& part) const { return text(part.from, part.to); }
  Part plain(std::size_t from, std::optional<double> number = {}) const {
    Part out;
    out.from = from;
    out.to = at_;
    out.number = number;
    out.zero = number == 0.0;
    out.vanishes.assign(quantities_.size(), out.zero);
    return out;
  }
  template <class Combine>
  static std::vector<bool> combined(const Part& a, const Part& b, const Combine& combine) {
    std::vector<bool> out(a.vanishes.size());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = combine(a.vanishes[k], b.vanishes[k]);
    return out;
  }
  /// One dimension on both sides; that of the result.
  Dimension agreed(const Part& a, const Part& b) {
    if (!a.zero && !b.zero && a.dimension != b.dimension) {
      const bool number = a.number || b.number;
      fail(fmt::format("`{}`: {} and {}{}", text(a.from, b.to), a.dimension.text(),
                       b.dimension.text(),
                       number ? " (a number has no unit: make it a parameter)" : ""));
    }
    return a.zero ? b.dimension : a.dimension;
  }
  void need_plain(const Part& part, std::string_view of) {
    if (!part.zero && !part.dimension.plain())
      fail(fmt::format("`{}`: {} takes a number without unit, not {}", text(part), of,
                       part.dimension.text()));
  }

  Part choice() {
    if (++depth_ > kDeepest) fail("the formula is nested too deeply");
    Part first = error_.empty() ? either() : plain(at_);
    if (error_.empty() && take("?")) {
      need_plain(first, "a condition");
      const Part yes = choice();
      if (error_.empty() && !take(":"))
        fail(fmt::format("`{}`: ':' is expected", text(first.from, at_)));
      const Part no = error_.empty() ? choice() : yes;
      Part out = plain(first.from);
      out.dimension = agreed(yes, no);
      out.zero = yes.zero && no.zero;
      out.vanishes = combined(yes, no, std::logical_and<>());
      first = out;
    }
    --depth_;
    return first;
  }
  /// Operands of one rung joined by conditions' operators; the result has no unit.
  Part conditions(Rung operand, std::span<const std::string_view> operators, bool compares) {
    Part left = (this->*operand)();
    while (error_.empty()) {
      const auto found = std::ranges::find_if(operators, [&](auto symbol) { return take(symbol); });
      if (found == operators.end()) break;
      const Part right = (this->*operand)();
      if (compares) {
        agreed(left, right);
      } else {
        need_plain(left, *found);
        need_plain(right, *found);
      }
      left = plain(left.from);
    }
    return left;
  }
  Part either() {
    static constexpr std::array<std::string_view, 1> kOr{"||"};
    return conditions(&Checker::both, kOr, false);
  }
  Part both() {
    static constexpr std::array<std::string_view, 1> kAnd{"&&"};
    return conditions(&Checker::compared, kAnd, false);
  }
  Part compared() {
    static constexpr std::array<std::string_view, 6> kCompare{"<=", ">=", "==", "!=", "<", ">"};
    return conditions(&Checker::sum, kCompare, true);
  }
  Part sum() {
    Part left = product();
    while (error_.empty()) {
      const bool plus = take("+");
      if (!plus && !take("-")) break;
      const Part right = product();
      Part out = plain(left.from);
      out.dimension = agreed(left, right);
      if (left.number && right.number) out.number = *left.number + (plus ? 1 : -1) * *right.number;
      out.zero = left.zero && right.zero;
      out.vanishes = combined(left, right, std::logical_and<>());
      left = std::move(out);
    }
    return left;
  }
  Part product() {
    Part left = signed_part();
    while (error_.empty()) {
      const bool times = take("*");
      if (!times && !take("/")) break;
      const Part right = signed_part();
      Part out = plain(left.from);
      out.dimension = times ? left.dimension * right.dimension : left.dimension / right.dimension;
      if (left.number && right.number)
        out.number = times ? *left.number * *right.number : *left.number / *right.number;
      out.zero = left.zero || (times && right.zero);
      out.vanishes = times ? combined(left, right, std::logical_or<>())
                           : combined(left, right, [](bool a, bool b) { return a && !b; });
      left = std::move(out);
    }
    return left;
  }
  Part signed_part() {
    skip_spaces();
    const std::size_t from = at_;
    if (++depth_ > kDeepest) fail("the formula is nested too deeply");
    const bool minus = take("-");
    Part out;
    if (minus || take("+")) {
      out = signed_part();
      out.from = from;
      if (minus && out.number) out.number = -*out.number;
    } else {
      out = powered(primary());
    }
    --depth_;
    return out;
  }
  Part powered(Part base) {
    if (!error_.empty() || !take("^")) return base;
    const Part exponent = signed_part();
    need_plain(exponent, "a power");
    Part out = plain(base.from);
    if (base.number && exponent.number) out.number = std::pow(*base.number, *exponent.number);
    if (exponent.number && *exponent.number > 0.0) {
      out.vanishes = base.vanishes;
      out.zero = base.zero;
    }
    if (base.zero || base.dimension.plain()) return out;
    const auto dimension = exponent.number ? base.dimension.power(*exponent.number) : std::nullopt;
    if (!dimension)
      fail(fmt::format("`{}`: {} to the power `{}`, which is not a plain number such as 2 or 0.5",
                       text(base), base.dimension.text(), text(exponent)));
    else
      out.dimension = *dimension;
    return out;
  }
  Part primary() {
    skip_spaces();
    const std::size_t from = at_;
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
    if (at_ < text_.size() && is_letter(text_[at_])) return named();
    if (take("(")) {
      Part inside = choice();
      if (error_.empty() && !take(")")) fail(fmt::format("`{}`: ')' is missing", text(from, at_)));
      inside.from = from;
      inside.to = at_;
      return inside;
    }
    if (error_.empty())
      fail(at_ < text_.size()
               ? fmt::format("`{}`: a number, a name or '(' is expected", text_.substr(at_, 20))
               : std::string("the formula ends where a number or a name is expected"));
    return plain(from);
  }
  Part number() {
    const std::size_t from = at_;
    while (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) ++at_;
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    }
    const std::string digits = text(from, at_);
    char* end = nullptr;
    const double value = std::strtod(digits.c_str(), &end);
    const bool glued = at_ < text_.size() && is_letter(text_[at_]);
    if (*end != '\0' || glued || !std::isfinite(value))
      fail(fmt::format("`{}`: not a number", text_.substr(from, at_ - from + glued)));
    return plain(from, value);
  }
  Part named() {
    const std::size_t from = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string name = text(from, at_);
    if (name == "pi") return plain(from, std::numbers::pi);
    if (take("(")) return call(from, name);
    const auto found = std::ranges::find(quantities_, name, &Quantity::name);
    if (found == quantities_.end()) {
      const std::string near = nearest_name(name);
      fail(fmt::format("`{}` is neither a parameter nor one of {}{}", name, names(),
                       near.empty() ? "" : fmt::format("; did you mean {}?", near)));
      return plain(from);
    }
    const auto k = std::size_t(found - quantities_.begin());
    uses_[k] = true;
    Part out = plain(from);
    out.dimension = found->dimension;
    out.vanishes[k] = true;
    return out;
  }
  Part call(std::size_t from, const std::string& name) {
    if (const auto* memory = find_memory_operator(name)) return remembered(from, *memory);
    const auto found = std::ranges::find(kFunctions, name, &Function::name);
    if (found == kFunctions.end()) {
      fail(fmt::format("`{}` is not a function; {} are", name, functions()));
      return plain(from);
    }
    Part first = choice();
    if (found->rule == Rule::several)
      while (error_.empty() && take(",")) {
        const Part next = choice();
        Part out = plain(first.from);
        out.dimension = agreed(first, next);
        out.zero = first.zero && next.zero;
        out.vanishes = combined(first, next, std::logical_and<>());
        first = std::move(out);
      }
    if (error_.empty() && !take(")")) fail(fmt::format("`{}`: ')' is missing", text(from, at_)));
    if (found->rule == Rule::plain) need_plain(first, name);
    Part out = plain(from);
    if (found->zero_at_zero) out.vanishes = first.vanishes;
    out.zero = found->zero_at_zero && first.zero;
    if (found->rule == Rule::same || found->rule == Rule::several) out.dimension = first.dimension;
    if (found->rule != Rule::root) return out;
    if (const auto root = first.dimension.power(0.5))
      out.dimension = *root;
    else
      fail(fmt::format("`{}`: {} has no root", text(first), first.dimension.text()));
    return out;
  }
  Part remembered(std::size_t from, const MemoryOperatorInfo& info) {
    MemoryCall call{info.id, from, 0, {}};
    std::vector<Part> given;
    for (std::size_t k = 0; k < info.count && error_.empty(); ++k) {
      if (k > 0 && !take(",")) break;
      skip_spaces();
      const std::size_t begins = at_;
      given.push_back(choice());
      call.arguments.emplace_back(begins, at_);
    }
    if (error_.empty() && (given.size() < info.count || !take(")")))
      fail(fmt::format("`{}`: {}({}) is expected", text(from, at_), info.name, info.arguments));
    if (!error_.empty()) return plain(from);
    for (std::size_t k = 0; k < given.size(); ++k) need(info.takes[k], given[k], given[0], info);
    call.to = at_;
    memories_.push_back(std::move(call));
    if (memories_.size() > kMostMemories)
      fail(fmt::format("at most {} operators that remember are taken", kMostMemories));
    Part out = plain(from);
    out.dimension = info.gives == MemoryUnit::as_first  ? given[0].dimension
                    : info.gives == MemoryUnit::product ? given[0].dimension * given[1].dimension
                    : info.gives == MemoryUnit::second  ? kSecond
                                                        : given[0].dimension / (kSecond * kSecond);
    if (info.zero_of_zero) out.vanishes = given[0].vanishes;
    if (info.gives == MemoryUnit::product)
      out.vanishes = combined(given[0], given[1], std::logical_or<>());
    return out;
  }
  void need(MemoryArgument what, const Part& part, const Part& first,
            const MemoryOperatorInfo& info) {
    const std::optional<Dimension> wanted = what == MemoryArgument::as_first ? first.dimension
                                            : what == MemoryArgument::plain  ? Dimension()
                                            : what == MemoryArgument::second ? kSecond
                                            : what == MemoryArgument::hertz  ? Dimension() / kSecond
                                            : what == MemoryArgument::length ? kMetre
                                            : what == MemoryArgument::speed
                                                ? kMetre / kSecond
                                                : std::optional<Dimension>();
    if (wanted && !part.zero && part.dimension != *wanted)
      fail(fmt::format("`{}`: {} where {}({}) takes {}", text(part), part.dimension.text(),
                       info.name, info.arguments, wanted->text()));
  }
  /// A quantity that was likely meant: "v_m_s" for "v" or "V_m_s"; empty for none.
  std::string nearest_name(std::string_view name) const {
    const auto small = [](std::string_view text) {
      std::string out(text);
      for (char& c : out) c = char(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
      return out;
    };
    std::string best;
    std::size_t least = 1 + name.size() / 3;
    for (const Quantity& q : quantities_) {
      const std::string theirs = small(q.name), ours = small(name);
      if (theirs.starts_with(ours + "_") || ours.starts_with(theirs + "_")) return q.name;
      if (const std::size_t off = edits(ours, theirs); off <= least) least = off, best = q.name;
    }
    return best;
  }
  /// Letters to insert, drop or change [Levenshtein1966].
  static std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j < row.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      std::size_t corner = row[0];
      row[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        const std::size_t above = row[j];
        row[j] = std::min({above + 1, row[j - 1] + 1, corner + (a[i - 1] != b[j - 1])});
        corner = above;
      }
    }
    return row.back();
  }
  std::string names() const {
    std::string out;
    for (const Quantity& q : quantities_) out += (out.empty() ? "" : ", ") + q.name;
    return out;
  }
  static std::string functions() {
    std::string out;
    for (const Function& f : kFunctions) out += (out.empty() ? "" : ", ") + std::string(f.name);
    for (const auto& memory : memory_operators()) out += ", " + std::string(memory.name);
    return out;
  }

  std::string_view text_;
  std::span<const Quantity> quantities_;
  std::vector<bool> uses_;
  std::vector<MemoryCall> memories_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::string error_;
};

}  // namespace

bool is_free_name(std::string_view name) {
  return !name.empty() && name.size() <= 40 && is_letter(name.front()) && name != "pi" &&
         std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); }) &&
         std::ranges::find(kFunctions, name, &Function::name) == kFunctions.end();
}

core::Result<FormulaFacts> check_formula(std::string_view formula,
                                         std::span<const Quantity> quantities,
                                         const std::optional<Dimension>& expected) {
  if (formula.size() > kLongest)
    return core::Error{
        core::Errc::too_large,
        fmt::format("{} characters where at most {} are taken", formula.size(), kLongest)};
  return Checker(formula, quantities).run(expected);
}

}  // namespace effects
}  // namespace tractus
