/// The one file that knows muParser. Its exceptions end here.
#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>

#include "core/trim.hpp"
#include "effects/formula.hpp"

namespace tractus {
namespace effects {

namespace {
thread_local std::uint64_t not_finite = 0;

double sign(double value) { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; }

/// No name of a quantity holds this character.
std::string memory_name(std::size_t k) { return "memory@" + std::to_string(k); }
}  // namespace

struct FormulaProgram::Parts {
  /// A part of the formula, or where the value of a single name stands.
  struct Piece {
    const double* name = nullptr;
    std::unique_ptr<mu::Parser> parser = {};
    double value() const { return name ? *name : parser->Eval(); }
  };
  struct Memory {
    MemoryOperator which;
    std::vector<Piece> arguments;
  };
  std::vector<double> inputs;  // quantities, then what the operators gave last
  std::size_t quantities = 0;
  std::vector<Memory> memories;
  Piece whole;

  void remember(const MemoryStep& step, FormulaMemory& memory);
};

namespace {

/// Characters from … to of a formula, each call of an operator in it replaced by its name.
std::string with_names(const std::string& formula, std::size_t from, std::size_t to,
                       std::span<const MemoryCall> memories) {
  std::string out;
  while (from < to) {
    std::size_t next = to, which = memories.size();
    for (std::size_t k = 0; k < memories.size(); ++k)  // of two that begin alike the outer is later
      if (memories[k].from >= from && memories[k].to <= to && memories[k].from <= next)
        next = memories[k].from, which = k;
    out += formula.substr(from, next - from);
    if (which == memories.size()) break;
    out += memory_name(which);
    from = memories[which].to;
  }
  return out;
}

}  // namespace

FormulaProgram::FormulaProgram(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
FormulaProgram::FormulaProgram(FormulaProgram&&) noexcept = default;
FormulaProgram& FormulaProgram::operator=(FormulaProgram&&) noexcept = default;
FormulaProgram::~FormulaProgram() = default;

core::Result<FormulaProgram> FormulaProgram::make(const std::string& formula,
                                                  std::span<const Quantity> quantities,
                                                  std::span<const MemoryCall> memories) {
  auto parts = std::make_unique<Parts>();
  parts->quantities = quantities.size();
  parts->inputs.assign(quantities.size() + memories.size(), 0.0);
  const auto piece = [&](std::size_t from, std::size_t to, std::size_t known) {
    const std::string text(core::trimmed(with_names(formula, from, to, memories.first(known))));
    Parts::Piece out;
    for (std::size_t k = 0; k < quantities.size(); ++k)
      if (quantities[k].name == text) out.name = &parts->inputs[k];
    if (out.name) return out;
    out.parser = std::make_unique<mu::Parser>();
    mu::Parser& parser = *out.parser;
    parser.DefineNameChars("0123456789_@abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    parser.ClearConst();
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineFun("sgn", sign);
    for (std::size_t k = 0; k < quantities.size(); ++k)
      parser.DefineVar(quantities[k].name, &parts->inputs[k]);
    for (std::size_t k = 0; k < known; ++k)
      parser.DefineVar(memory_name(k), &parts->inputs[quantities.size() + k]);
    parser.SetExpr(text);
    parser.Eval();  // compiles, so that no later evaluation does
    return out;
  };
  try {
    for (std::size_t k = 0; k < memories.size(); ++k) {
      Parts::Memory& memory = parts->memories.emplace_back(Parts::Memory{memories[k].which, {}});
      for (const auto& [from, to] : memories[k].arguments)
        memory.arguments.push_back(piece(from, to, k));
    }
    parts->whole = piece(0, formula.size(), memories.size());
  } catch (const mu::Parser::exception_type& error) {
    return core::Error{core::Errc::bad_input, fmt::format("`{}`: {}", formula, error.GetMsg())};
  }
  return FormulaProgram(std::move(parts));
}

void FormulaProgram::Parts::remember(const MemoryStep& step, FormulaMemory& memory) {
  for (std::size_t k = 0; k < memories.size(); ++k) {
    MemoryArguments of{};
    for (std::size_t i = 0; i < memories[k].arguments.size(); ++i)
      of[i] = memories[k].arguments[i].value();
    const MemoryStates states(memory.states.data() + kStatesOfMemory * k, kStatesOfMemory);
    inputs[quantities + k] = memory.started ? advance(memories[k].which, of, step, states)
                                            : begin(memories[k].which, of, states);
  }
  memory.started = true;
}

std::span<double> FormulaProgram::inputs() const noexcept {
  return std::span(parts_->inputs).first(parts_->quantities);
}

bool FormulaProgram::remembers() const noexcept { return !parts_->memories.empty(); }

std::uint64_t FormulaProgram::times_not_finite() noexcept { return not_finite; }

double FormulaProgram::value() const noexcept {
  FormulaMemory none;
  return value({}, none);
}

double FormulaProgram::value(const MemoryStep& step, FormulaMemory& memory) const noexcept {
  try {
    parts_->remember(step, memory);
    const double value = parts_->whole.value();
    if (std::isfinite(value)) return value;
    ++not_finite;
    return 0.0;
  } catch (const mu::Parser::exception_type&) {
    return 0.0;  // nothing that was compiled throws; a law that cannot be told adds nothing
  }
}

}  // namespace effects
}  // namespace tractus
