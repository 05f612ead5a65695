/// When a study may be looked at before it is complete: bounds that keep α, and what they cost.
#include <fmt/format.h>

#include <sstream>

#include "assessment/report.hpp"
#include "core/try.hpp"
#include "statistics/power/sequential_looks.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

/// "4", four even looks; "0.3 0.7 1", the shares of the data at each.
core::Result<std::vector<double>> shares_in(const std::string& text) {
  std::vector<double> out;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const auto number = number_in(word);
    if (!number)
      return core::bad_input(fmt::format("looks: '{}' in at '{}' is no number", word, text));
    out.push_back(*number);
  }
  if (out.size() != 1 || out[0] == 1.0) return out;
  if (!(out[0] >= 1.0 && out[0] <= 50.0) || out[0] != double(int(out[0])))
    return core::bad_input(fmt::format("looks: at is '{}'; 1 to 50 looks are expected", text));
  const int looks = int(out[0]);
  out.clear();
  for (int k = 1; k <= looks; ++k) out.push_back(double(k) / looks);
  return out;
}

core::Result<Findings> run_looks(const Analysis& of) {
  const bool pocock = of.text("spending") == "pocock";
  const double alpha = of.number("alpha"), power = of.number("power");
  if (!(power > alpha)) return core::bad_input("looks: power should be above alpha");
  const auto shares = TRY(shares_in(of.text("at")));
  const auto looks = TRY(statistics::sequential_looks(
      shares, pocock ? statistics::Spending::pocock : statistics::Spending::obrien_fleming, alpha,
      power));
  Json out = {{"method", "sequential looks with alpha spending"}};
  out["design"] = {{"spending", of.text("spending")}, {"alpha", alpha}, {"power", power}};
  out["looks"] = Json::array();
  for (std::size_t k = 0; k < shares.size(); ++k)
    out["looks"].push_back({{"share_of_data", shares[k]},
                            {"significant_where_p_below", looks.nominal_p[k]},
                            {"z_bound", looks.bounds[k]},
                            {"alpha_spent", looks.spent[k]},
                            {"stopped_by_then", looks.stopped_by[k]}});
  out["answer"] = {{"times_the_size_of_one_look", looks.inflation},
                   {"mean_share_used", looks.mean_share}};
  out["notes"] = {
      "at each look compare the p of the planned test with significant_where_p_below, and stop "
      "where it is smaller; the looks and their number are fixed before the first one"};
  return Findings{std::move(out), {}};
}

}  // namespace

namespace methods {
Method looks_method() {
  return {"looks",
          "Looking at a study's data before it is complete, at a kept error rate",
          "",
          "sequential looks with an alpha-spending function",
          {{"at",
            "number of even looks, or the share of the data at each: \"0.3 0.7 1\"",
            "3",
            {},
            0,
            0,
            true},
           {"spending",
            "how alpha is spent: late (obrien-fleming) or evenly (pocock)",
            "obrien-fleming",
            {"obrien-fleming", "pocock"}},
           {"alpha", "two-sided level of all looks together", "0.05", {}, 1e-6, 0.5},
           {"power", "of the planned effect, over all looks", "0.8", {}, 0.01, 0.9999}},
          run_looks};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
