#include "assessment/sequences.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "assessment/counts.hpp"
#include "core/try.hpp"

namespace tractus::assessment {

core::Result<std::vector<Sequence>> sequences_of(const Analysis& of, const std::string& order) {
  const auto failed = TRY(yes_no(of.table, of.formula.response));
  const auto when = TRY(of.table.numbers(order));
  Parts parts{{"all"}, {{}}};
  if (of.formula.group.empty())
    for (std::size_t i = 0; i < failed.size(); ++i) parts.rows[0].push_back(i);
  else
    parts = parts_of(of.table, of.formula.group);
  const bool success = of.text("response") == "success";
  std::vector<Sequence> out;
  for (std::size_t j = 0; j < parts.names.size(); ++j) {
    auto rows = parts.rows[j];
    const auto time = [&](std::size_t i) { return when[static_cast<Eigen::Index>(i)]; };
    std::ranges::stable_sort(rows, {}, time);
    Sequence sequence{parts.names[j], {}};
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (k > 0 && time(rows[k]) == time(rows[k - 1]))
        return core::bad_input(fmt::format(
            "{}:{}: '{}' is {} twice for '{}': the order of trials is not "
            "known",
            of.table.name(), of.table.line(rows[k]), order, time(rows[k]), sequence.name));
      sequence.failures.push_back(failed[rows[k]] != success);
    }
    out.push_back(std::move(sequence));
  }
  return out;
}

}  // namespace tractus::assessment
