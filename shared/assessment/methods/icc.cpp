/// Reliability of repeated measurements.
#include "statistics/agreement/icc.hpp"

#include <cmath>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

Json row(const char* name, const char* meaning, double single, const statistics::Interval& ci,
         double mean) {
  return {{"icc", name},        {"meaning", meaning},   {"of_one", single},
          {"ci95_low", ci.low}, {"ci95_high", ci.high}, {"of_the_mean", mean}};
}

core::Result<Findings> run_icc(const Analysis& of) {
  const auto column = TRY(single_column(of, "icc"));
  if (of.formula.group.empty())
    return core::bad_input("icc needs the subject: write y ~ repetition + (1|subject)");
  const auto y = TRY(of.table.numbers(of.formula.response));
  const auto cells = TRY(cells_of(of, {column}, y));
  const auto fit = statistics::icc(cells.values);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "intraclass correlation");
  out["icc"] =
      Json::array({row("(1)", "one-way, agreement", fit->icc1, fit->icc1_95, fit->icc1k),
                   row("(2)", "two-way random, agreement", fit->icc2, fit->icc2_95, fit->icc2k),
                   row("(3)", "two-way mixed, consistency", fit->icc3, fit->icc3_95, fit->icc3k)});
  out["error"] = {{"sem_agreement", fit->sem_agreement},
                  {"sem_consistency", fit->sem_consistency},
                  {"smallest_detectable_change_95", fit->mdc95_consistency}};
  const double n = static_cast<double>(cells.values.rows()),
               k = static_cast<double>(cells.values.cols());
  out["tests"] =
      Json::array({Test{"ICC(3)", "F", fit->f23, n - 1.0, (n - 1.0) * (k - 1.0), fit->p23, "ICC(3)",
                        fit->icc3, fit->icc3_95.low, fit->icc3_95.high}
                       .to_json()});
  return Findings{std::move(out),
                  {profile_picture(cells.names, cells.values, of.formula.response)}};
}

}  // namespace

namespace methods {
Method icc_method() {
  return {"icc",
          "Reliability: intraclass correlations, SEM, smallest detectable change",
          "force_N ~ repetition + (1|surgeon)",
          "intraclass correlations of Shrout and Fleiss 1979 with the intervals of McGraw and Wong "
          "1996",
          {},
          run_icc};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
