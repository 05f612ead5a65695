/// Exact tests by counting every arrangement.
#include "statistics/ranks/permutation.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

core::Result<Findings> slope(const Analysis& of, const std::string& column, const Vector& y) {
  const auto x = TRY(of.table.numbers(column));
  const auto test = statistics::permutation_slope(x, y);
  if (!test) return located(of, test.error());
  Json out = report_head(of, "exact permutation test of a slope");
  out["analysis"] = {{"p", test->p},
                     {"p_greater", test->p_greater},
                     {"p_less", test->p_less},
                     {"arrangements", test->arrangements},
                     {"as_extreme", test->as_extreme}};
  const Vector centred = x.array() - x.mean();
  const double b = centred.dot(y) / centred.squaredNorm(), none = std::nan("");
  out["tests"] =
      Json::array({Test{column, "exact", b, 0, 0, test->p, "slope", b, none, none}.to_json()});
  return Findings{std::move(out), {}};
}

core::Result<Findings> signs(const Analysis& of, const std::string& column, const Vector& y) {
  const auto cells = TRY(cells_of(of, {column}, y));
  if (cells.names.size() != 2)
    return core::bad_input(fmt::format("{}: column '{}' has {} levels; flipping signs compares two",
                                       of.table.name(), column, cells.names.size()));
  const Vector difference = cells.values.col(1) - cells.values.col(0);
  const auto test = statistics::sign_flip(difference);
  if (!test) return located(of, test.error());
  Json out = report_head(of, "exact test of paired differences by flipping signs");
  out["compared"] = cells.names[1] + " minus " + cells.names[0];
  out["analysis"] = {{"mean_difference", difference.mean()},
                     {"p", test->p},
                     {"flips", test->flips},
                     {"as_extreme", test->as_extreme}};
  const double none = std::nan("");
  out["tests"] = Json::array({Test{column, "exact", difference.mean(), 0, 0, test->p,
                                   "mean difference", difference.mean(), none, none}
                                  .to_json()});
  return Findings{std::move(out), {}};
}

core::Result<Findings> run_permutation(const Analysis& of) {
  const auto column = TRY(single_column(of, "permutation"));
  const auto y = TRY(of.table.numbers(of.formula.response));
  return of.formula.group.empty() ? slope(of, column, y) : signs(of, column, y);
}

}  // namespace

namespace methods {
Method permutation_method() {
  return {"permutation",
          "Exact test of a slope, or of two levels with (1|subject), for few people",
          "wrong_breach ~ experience_years",
          "an exact permutation test over all arrangements",
          {},
          run_permutation};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
