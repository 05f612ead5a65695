/// What was there against what was said.
#include "statistics/agreement/confusion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assessment/report.hpp"
#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

/// All labels of both columns, once.
std::vector<std::string> classes_of(const Table& table, const std::string& a,
                                    const std::string& b) {
  auto out = levels_of(table, a);
  for (const auto& level : levels_of(table, b))
    if (std::ranges::find(out, level) == out.end()) out.push_back(level);
  return out;
}

Json matrix_table(const std::vector<std::string>& classes, const statistics::Matrix& counts) {
  Json out = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    Json row = {{"truth", classes[i]}};
    for (std::size_t j = 0; j < classes.size(); ++j)
      row["said " + classes[j]] =
          static_cast<long>(counts(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    out.push_back(std::move(row));
  }
  return out;
}

core::Result<Findings> run_confusion(const Analysis& of) {
  const auto truth = TRY(single_column(of, "confusion"));
  const auto classes = classes_of(of.table, truth, of.formula.response);
  if (classes.size() ==
      levels_of(of.table, truth).size() + levels_of(of.table, of.formula.response).size())
    return core::bad_input(
        fmt::format("{}: '{}' and '{}' have no label in common, as '{}' and '{}'", of.table.name(),
                    truth, of.formula.response, classes.front(), classes.back()));
  if (classes.size() > 50)
    return core::bad_input(fmt::format("{}: {} classes are too many for a table (at most 50)",
                                       of.table.name(), classes.size()));
  statistics::Matrix counts = statistics::Matrix::Zero(std::ssize(classes), std::ssize(classes));
  const auto was = places_of(of.table, truth, classes);
  const auto said = places_of(of.table, of.formula.response, classes);
  for (std::size_t i = 0; i < was.size(); ++i)
    counts(static_cast<Eigen::Index>(was[i]), static_cast<Eigen::Index>(said[i])) += 1.0;
  const auto fit = statistics::confusion(counts);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "confusion of classes");
  out["counts"] = matrix_table(classes, counts);
  out["classes"] = coefficient_table(classes, {{"precision", &fit->precision},
                                               {"recall", &fit->recall},
                                               {"specificity", &fit->specificity},
                                               {"f1", &fit->f1}});
  out["agreement"] = {{"accuracy", fit->accuracy},
                      {"accuracy_ci95_low", fit->accuracy_95.low},
                      {"accuracy_ci95_high", fit->accuracy_95.high},
                      {"kappa", fit->kappa},
                      {"kappa_standard_error", fit->kappa_se},
                      {"kappa_ci95_low", fit->kappa_95.low},
                      {"kappa_ci95_high", fit->kappa_95.high},
                      {"balanced_accuracy", fit->balanced_accuracy},
                      {"macro_f1", fit->macro_f1},
                      {"matthews_correlation", fit->mcc},
                      {"no_information_rate", fit->no_information_rate},
                      {"p_above_no_information", fit->p_above_no_information},
                      {"bowker_chi_squared", fit->bowker}};
  const double z = fit->kappa / fit->kappa_se_null;
  out["tests"] =
      Json::array({Test{"kappa", "z", z, 0, 0, 2.0 * statistics::normal_upper(std::abs(z)),
                        "Cohen's kappa", fit->kappa, fit->kappa_95.low, fit->kappa_95.high}
                       .to_json()});
  out["notes"] = {"a class that was never said has precision and F1 of 0 by convention"};
  return Findings{std::move(out), {}};
}

}  // namespace

namespace methods {
Method confusion_method() {
  return {"confusion",
          "Which scenario was taken for which: kappa, precision, recall, F1",
          "response ~ scenario",
          "Cohen's kappa with the standard error of Fleiss, Cohen and Everitt 1969",
          {},
          run_confusion};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
