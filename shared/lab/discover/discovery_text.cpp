#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/discover/discovery.hpp"
#include "lab/identify/verdict_text.hpp"

namespace tractus {
namespace lab {
namespace {

std::string share_text(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

std::string numbers_text(const ProposedTerm& term) {
  std::string out;
  for (const ProposedNumber& n : term.numbers) {
    const std::string unit = n.unit == "1" ? "" : " " + n.unit;
    out += fmt::format("       {} = {}{} (90 %: {} to {}), {}\n", n.name, figure(n.value), unit,
                       figure(n.low), figure(n.high), n.meaning);
  }
  return out;
}

std::string proposal_text(const Proposal& p, std::size_t number, std::string_view unit) {
  std::string out = fmt::format("  {}. {}\n", number, formula_text(p));
  for (const ProposedTerm& term : p.terms)
    out += fmt::format("     {}\n{}", term.words, numbers_text(term));
  if (!p.beside.empty()) out += fmt::format("     beside {}\n", fmt::join(p.beside, ", "));
  out += fmt::format(
      "     held out {}, better on {} of {} trials; probability {}, best in {} of the "
      "resamplings; {}\n",
      figure(p.held_out_rmse, unit), p.trials_improved, p.trials, share_text(p.probability),
      share_text(p.stability),
      p.passive ? "passive"
                : "not passive: it returns work over a cycle, feel it with the station's passivity "
                  "controller alone");
  return out;
}

}  // namespace

std::string formula_text(const Proposal& proposal) {
  std::vector<std::string> terms;
  for (const ProposedTerm& term : proposal.terms) terms.push_back(term.formula);
  return fmt::format("{}", fmt::join(terms, " + "));
}

std::string sentences(const Discovery& d, std::string_view unit) {
  if (d.formulas_tried == 0) return fmt::format("No formula is proposed: {}.\n", d.remark);
  std::string out;
  if (d.unknown && d.unknown_probability > 0.5)
    out += fmt::format(
        "What is missing is more likely an unknown function of {} than any formula that was tried "
        "({}). It is in the answer as a table.\n",
        fmt::join(d.unknown->signals, " and "), share_text(d.unknown_probability));
  if (!d.remark.empty()) out += fmt::format("No formula is proposed: {}.\n", d.remark);
  if (d.proposals.empty()) return out;
  out += fmt::format(
      "Formulas for what is missing, of {} that were tried; the error without them is {}, the "
      "noise floor {}:\n",
      d.formulas_tried, figure(d.base_held_out_rmse, unit), figure(d.noise_floor, unit));
  for (std::size_t k = 0; k < d.proposals.size(); ++k)
    out += proposal_text(d.proposals[k], k + 1, unit);
  return out;
}

}  // namespace lab
}  // namespace tractus
