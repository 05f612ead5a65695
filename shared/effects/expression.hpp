/// A user's own effect: a formula over named states, with its units checked.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "effects/effect.hpp"
#include "effects/formula.hpp"

namespace tractus::effects {

inline constexpr std::string_view kEffectFormat = "tractus-effect/1";
inline constexpr std::string_view kExpressionPrefix = "expression:";

/// A state that a formula may name: as in the measurements' columns, and its unit.
struct ExpressionState {
  std::string_view name, unit, meaning;
};

/// What a formula of one rig adds to, and what it may name.
struct ExpressionRig {
  std::string_view rig;      ///< "probing"
  std::string_view adds_to;  ///< "fz_N"
  std::string_view unit;     ///< that the result must have: "N"
  std::span<const ExpressionState> states;
  std::string_view experiment;  ///< what to record so that an unknown formula shows
  bool remembers = true;        ///< takes operators that remember
};
/// fz_N, added to the resisting force: from x_m v_m_s a_m_s2 theta_rad omega_rad_s t_s tz_Nm
/// base_N.
const ExpressionRig& probing_expressions();

/// `tractus-effect/1`:
///
///     {"format": "tractus-effect/1", "id": "expression:my_drag", "rig": "probing",
///      "adds_to": "fz_N", "formula": "c * v_m_s * abs(v_m_s)", "summary": "…",
///      "parameters": {"c": {"unit": "N*s^2/m^2", "initial": 1, "low": 0, "high": 1e4,
///                           "meaning": "…", "logarithmic": false}}}
///
/// `summary`, `meaning` and `logarithmic` may be missing. The formula's grammar: check_formula. It
/// is a force of the law: replayed, fitted and felt.
class Expression {
 public:
  /// @param where  leads every message, as "my.json: ". Errors: bad_input naming the field; in the
  /// formula, the part whose units do not fit.
  static core::Result<Expression> from_json(const core::Json& json, const std::string& where,
                                            const ExpressionRig& rig);
  static core::Result<Expression> read(const std::filesystem::path& path, const ExpressionRig& rig);
  /// From EffectInstance::definition.
  static core::Result<Expression> of(const EffectInstance& use, const ExpressionRig& rig);

  core::Json to_json() const;
  /// As an effect in a model. @param values  the initial ones where empty.
  EffectInstance use(std::vector<double> values = {}) const;
  /// As of an entry of the catalogue: off at 0 of a parameter that is a factor of the whole
  /// formula; not declared passive, as nobody knows.
  const EffectFacts& facts() const noexcept { return facts_; }
  /// Ready to evaluate: inputs are the rig's states in order, then the parameters.
  core::Result<FormulaProgram> program() const;

 private:
  Expression() = default;
  std::string rig_, adds_to_;
  std::vector<std::string> units_;    // of the parameters
  std::vector<Quantity> quantities_;  // states, then parameters
  std::vector<MemoryCall> memories_;  // of the formula
  EffectFacts facts_;                 // equation: the formula
};

/// Is it the id of a user's expression?
bool is_expression(std::string_view id);
/// "your own effect “my drag”" of "expression:my_drag".
std::string expression_label(std::string_view id);

}  // namespace tractus::effects
