/// Power of a planned test, or the number of people it needs.
#include "statistics/summary/power.hpp"

#include <fmt/format.h>

#include <cmath>

#include "assessment/report.hpp"
#include "assessment/simulated_power.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

/// Power as a function of n, what n counts, and the smallest n that makes sense.
struct Curve {
  std::function<double(double)> power;
  const char* counts = "";
  double least = 2.0;
};

Curve curve_of(const Analysis& of) {
  const std::string& test = of.text("test");
  const double effect = of.number("effect"), alpha = of.number("alpha"),
               groups = of.number("levels");
  if (test == "two-samples")
    return {[=](double n) { return statistics::power_two_samples(effect, n, alpha); },
            "people per group", 2.0};
  if (test == "paired")
    return {[=](double n) { return statistics::power_paired(effect, n, alpha); }, "pairs", 2.0};
  if (test == "correlation")
    return {[=](double n) { return statistics::power_correlation(effect, n, alpha); }, "people",
            4.0};
  if (test == "anova")
    return {[=](double n) { return statistics::power_one_way(effect, groups, n, alpha); },
            "people per group", 2.0};
  if (test == "regression")
    return {[=](double n) {
              return statistics::power_regression(effect, groups, n - groups - 1.0, alpha);
            },
            "people", groups + 2.0};
  if (test == "two-proportions")
    return {[=](double n) { return statistics::power_two_proportions(effect, n, alpha); },
            "people per group", 2.0};
  const statistics::RepeatedDesign design{effect, groups, of.number("correlation"),
                                          of.number("epsilon")};
  return {[=](double n) { return statistics::power_repeated(design, n, alpha); }, "people", 2.0};
}

core::Result<Findings> run_power(const Analysis& of) {
  if (of.text("test") == "mixed" && of.number("effect") != 0.0) return simulated_power(of);
  const Curve curve = curve_of(of);
  if (of.number("effect") == 0.0) return core::bad_input("power: an effect of 0 is never found");
  if (of.text("test") == "correlation" && std::abs(of.number("effect")) >= 1.0)
    return core::bad_input("power: a correlation lies between -1 and 1");
  Json out = {{"method", fmt::format("power of a test: {}", of.text("test"))}};
  out["design"] = {{"effect", of.number("effect")}, {"alpha", of.number("alpha")}};
  if (of.given("n")) {
    const double n = of.number("n");
    if (n < curve.least)
      return core::bad_input(
          fmt::format("power: n is {}; at least {} {} are needed", n, curve.least, curve.counts));
    out["answer"] = {{"n", n}, {"counts", curve.counts}, {"power", curve.power(n)}};
  } else {
    const double target = of.number("power");
    const auto n = TRY(statistics::needed_size(curve.power, target, curve.least));
    const double whole = std::ceil(n - 1e-9);
    out["answer"] = {{"power_wanted", target},
                     {"n", whole},
                     {"counts", curve.counts},
                     {"n_exact", n},
                     {"power", curve.power(whole)}};
  }
  out["notes"] = Json::array();
  return Findings{std::move(out), {}};
}

}  // namespace

namespace methods {
Method power_method() {
  std::vector<Option> options = {
      {"test",
       "what is planned",
       "repeated",
       {"repeated", "paired", "two-samples", "anova", "correlation", "regression",
        "two-proportions", "mixed"}},
      {"effect",
       "d, r, f, f2 or h of Cohen 1988, as the test has it; of mixed in the response's unit, "
       "per trial or between the two",
       "0.25",
       {},
       -1e6,
       1e6},
      {"n", "people (per group where there are groups); absent: the n for --power", "", {}, 1, 1e6},
      {"power", "chance wanted of finding the effect", "0.8", {}, 0.01, 0.9999},
      {"alpha", "two-sided level", "0.05", {}, 1e-9, 0.5},
      {"levels", "groups, repeated levels, or predictors of a regression", "3", {}, 1, 1000},
      {"correlation", "between the repeated levels", "0.5", {}, -0.99, 0.999},
      {"epsilon", "departure from sphericity", "1", {}, 0.01, 1}};
  for (auto& option : simulated_power_options()) options.push_back(std::move(option));
  return {"power",
          "Power of a planned study, or how many people it needs",
          "",
          "power by the noncentral t and F distributions, and of mixed models by simulation",
          std::move(options),
          run_power};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
