/// The one file that knows muParser. Its exceptions end here.
#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>

#include "effects/formula.hpp"

namespace tractus {
namespace effects {

namespace {
thread_local std::uint64_t not_finite = 0;

double sign(double value) { return value > 0.0 ? 1.0 : value < 0.0 ? -1.0 : 0.0; }
}  // namespace

struct FormulaProgram::Parts {
  std::vector<double> inputs;
  mu::Parser parser;
};

FormulaProgram::FormulaProgram(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
FormulaProgram::FormulaProgram(FormulaProgram&&) noexcept = default;
FormulaProgram& FormulaProgram::operator=(FormulaProgram&&) noexcept = default;
FormulaProgram::~FormulaProgram() = default;

core::Result<FormulaProgram> FormulaProgram::make(const std::string& formula,
                                                  std::span<const Quantity> quantities) {
  auto parts = std::make_unique<Parts>();
  parts->inputs.assign(quantities.size(), 0.0);
  try {
    parts->parser.ClearConst();
    parts->parser.DefineConst("pi", std::numbers::pi);
    parts->parser.DefineFun("sgn", sign);
    for (std::size_t k = 0; k < quantities.size(); ++k)
      parts->parser.DefineVar(quantities[k].name, &parts->inputs[k]);
    parts->parser.SetExpr(formula);
    parts->parser.Eval();  // compiles, so that no later evaluation does
  } catch (const mu::Parser::exception_type& error) {
    return core::Error{core::Errc::bad_input, fmt::format("`{}`: {}", formula, error.GetMsg())};
  }
  return FormulaProgram(std::move(parts));
}

std::span<double> FormulaProgram::inputs() const noexcept { return parts_->inputs; }

std::uint64_t FormulaProgram::times_not_finite() noexcept { return not_finite; }

double FormulaProgram::value() const noexcept {
  try {
    const double value = parts_->parser.Eval();
    if (std::isfinite(value)) return value;
    ++not_finite;
    return 0.0;
  } catch (const mu::Parser::exception_type&) {
    return 0.0;  // nothing that was compiled throws; a law that cannot be told adds nothing
  }
}

}  // namespace effects
}  // namespace tractus
