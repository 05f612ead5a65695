/// In place of effects/formula_program.cpp, for models without formulas: so their FMUs need no muParser.
#include "effects/formula.hpp"

namespace tractus {
namespace effects {

struct FormulaProgram::Parts {};

FormulaProgram::FormulaProgram(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
FormulaProgram::FormulaProgram(FormulaProgram&&) noexcept = default;
FormulaProgram& FormulaProgram::operator=(FormulaProgram&&) noexcept = default;
FormulaProgram::~FormulaProgram() = default;

core::Result<FormulaProgram> FormulaProgram::make(const std::string& formula,
                                                  std::span<const Quantity>,
                                                  std::span<const MemoryCall>) {
  return core::bad_input("`" + formula + "`: this FMU computes no formulas");
}
std::span<double> FormulaProgram::inputs() const noexcept { return {}; }
bool FormulaProgram::remembers() const noexcept { return false; }
double FormulaProgram::value() const noexcept { return 0.0; }
double FormulaProgram::value(const MemoryStep&, FormulaMemory&) const noexcept { return 0.0; }

}  // namespace effects
}  // namespace tractus
