#include "assessment/counts.hpp"

#include <fmt/format.h>

#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {

core::Result<std::vector<bool>> yes_no(const Table& table, const std::string& column) {
  std::vector<bool> out;
  const auto& cells = table.texts(column);
  out.reserve(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto cell = cells[i];
    const bool yes = cell == "1" || cell == "true" || cell == "yes" || cell == "TRUE";
    if (!yes && cell != "0" && cell != "false" && cell != "no" && cell != "FALSE")
      return core::bad_input(fmt::format("{}:{}: column '{}' should be 0 or 1 and is '{}'",
                                         table.name(), table.line(i), column, cell.substr(0, 40)));
    out.push_back(yes);
  }
  return out;
}

namespace {

/// Trials of each row: 1, a number, or a column's.
core::Result<statistics::Vector> trials_of(const Analysis& of, Eigen::Index rows) {
  if (of.formula.trials.empty())
    return statistics::Vector(statistics::Vector::Constant(rows, of.formula.trials_number));
  return of.table.numbers(of.formula.trials);
}

}  // namespace

core::Result<std::vector<Counted>> counted_groups(const Analysis& of) {
  if (of.formula.terms.size() > 1 || !of.formula.group.empty())
    return core::bad_input(
        "proportions are of all rows (y ~ 1) or by one column (y ~ column); with (1|person) or "
        "more columns use logistic");
  const auto y = TRY(of.table.numbers(of.formula.response));
  const auto trials = TRY(trials_of(of, y.size()));
  Parts parts{{"all"}, {{}}};
  if (!of.formula.terms.empty()) {
    const auto column = single_column({of.formula, of.table, "", {}}, "proportions");
    parts = parts_of(of.table, of.formula.terms[0].variables[0].column);
  } else {
    for (std::size_t i = 0; i < of.table.rows(); ++i) parts.rows[0].push_back(i);
  }
  std::vector<Counted> out;
  for (std::size_t j = 0; j < parts.names.size(); ++j) {
    Counted group{parts.names[j], {}};
    for (const std::size_t i : parts.rows[j]) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto one = statistics::Proportion::make(y[row], trials[row]);
      if (!one)
        return core::bad_input(
            fmt::format("{}:{}: {} of {} is no count of successes: whole numbers, 0 to "
                        "the trials, are expected",
                        of.table.name(), of.table.line(i), y[row], trials[row]));
      group.of.successes += one->successes;
      group.of.trials += one->trials;
    }
    out.push_back(group);
  }
  return out;
}

}  // namespace assessment
}  // namespace tractus
