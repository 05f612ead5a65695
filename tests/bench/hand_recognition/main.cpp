/// How often the SIMULATED hand is right: trials on every form of the cases of real pedicles, whole
/// and breached, against what each certificate foretells.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "bench/hand_recognition/foretelling.hpp"
#include "bench/hand_recognition/palpating.hpp"
#include "bench/hand_recognition/tally.hpp"
#include "core/progress.hpp"
#include "core/require.hpp"
#include "station/loop/placement.hpp"

namespace tractus {
namespace {

using volume::Preparation;

/// Of the senses' noise, times that of people.
constexpr std::array kNoise{1.0, 3.0, 9.0};

devices::HandSense sense_of(double noise) {
  devices::HandSense out;
  out.force_threshold_N *= noise, out.force_weber *= noise;
  return out;
}

struct Wanted {
  std::size_t pedicles = 0, first = 0;
  int trials = 3;
  std::uint64_t seed = 100'000;  ///< of the first trial; below are those it was developed with
  double duration_s = 30.0;
  std::filesystem::path keep, scatter;
};

const char* option(int argc, char** argv, const char* name, const char* otherwise) {
  for (int k = 1; k + 1 < argc; ++k)
    if (std::strcmp(argv[k], name) == 0) return argv[k + 1];
  return otherwise;
}

Wanted wanted_of(int argc, char** argv, std::size_t all) {
  const auto number = [&](const char* name, const std::string& otherwise) {
    return std::atof(option(argc, argv, name, otherwise.c_str()));
  };
  return {.pedicles = std::min(all, std::size_t(number("--pedicles", std::to_string(all)))),
          .first = std::min(all, std::size_t(number("--first", "0"))),
          .trials = int(number("--trials", "3")),
          .seed = std::uint64_t(number("--seed", "100000")),
          .duration_s = number("--duration", "30"),
          .keep = option(argc, argv, "--keep", ""),
          .scatter = option(argc, argv, "--scatter", "")};
}

bench::Tried tried(const std::string& where, const bench::Form& form, double noise,
                   const Wanted& wanted, std::uint64_t& seed) {
  const auto model = bench::published_model();
  const auto runtime = models::PalpationRuntime::make(model, form.carved.volume);
  core::require(bool(runtime), "a field can be made of a volume that was drilled");
  bench::Tried out{
      .where = where,
      .breach = form.breach,
      .chosen = form.chosen,
      .noise = noise,
      .at_m = form.at_m,
      .rim_m = loop::enclosed_from_m(form.carved.volume, model.transfer, form.carved.tract),
      .passes = form.passes,
      .trials = wanted.trials};
  const std::string truth = form.breach ? std::string(name(*form.breach)) : "whole";
  for (int trial = 0; trial < wanted.trials; ++trial) {
    const auto answer = bench::palpated(form, *runtime, seed++, wanted.duration_s, sense_of(noise));
    out.said.push_back(answer.breach ? answer.wall : "whole");
    out.right += out.said.back() == truth;
  }
  return out;
}

void say(const bench::Tried& one) {
  std::string said;
  for (const auto& word : one.said) said += " " + word;
  fmt::print("{:34} {:9}{} x{:<3} {:24} {}/{}{}\n", one.where,
             one.breach ? std::string(name(*one.breach)) : "whole", one.chosen ? ' ' : '-',
             one.noise,
             one.breach ? fmt::format("{:2.0f} of {:2.0f} mm{} {:3.0f} %", one.at_m * 1e3,
                                      one.rim_m * 1e3, one.passes ? " " : "!", 100.0 * one.foretold)
                        : "",
             one.right, one.trials, one.right == one.trials ? "" : said);
  std::fflush(stdout);
}

/// A pedicle's forms, under senses from those of people to much worse.
void try_pedicle(const std::string& where, const std::vector<bench::Form>& forms,
                 const Wanted& wanted, std::uint64_t& seed, std::vector<bench::Tried>& out) {
  const bench::Foretelling foretelling(forms.front());
  for (const bench::Form& form : forms) {
    const auto felt = foretelling.palpated(form);
    for (const double noise : kNoise) {
      auto one = tried(where, form, noise, wanted, seed);
      if (form.breach) one.foretold = foretelling.share_right(form, felt, sense_of(noise));
      say(one);
      out.push_back(std::move(one));
    }
  }
}

std::vector<bench::Tried> trials_of(const Wanted& wanted, Preparation preparation,
                                    const core::Progress& progress) {
  const auto all = bench::pedicles();
  std::vector<bench::Tried> out;
  for (std::size_t n = wanted.first; n < wanted.pedicles; ++n) {
    const std::string where = bench::name_of(all[n], preparation);
    std::uint64_t seed = wanted.seed + 2000 * n + (preparation == Preparation::filled ? 0 : 1000);
    const auto forms = bench::forms_of(all[n], preparation, wanted.keep);
    if (forms)
      try_pedicle(where, *forms, wanted, seed, out);
    else
      fmt::print("{:34} {}\n", where, forms.error().what);
    if (progress) progress(double(n + 1 - wanted.first) / double(wanted.pedicles - wanted.first));
  }
  return out;
}

int shares(const std::vector<bench::Tried>& tried, bool whole, int bench::Tried::*count) {
  int sum = 0;
  for (const auto& one : tried)
    if (!whole || !one.breach) sum += one.*count;
  return sum;
}

}  // namespace
}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  const Wanted wanted = wanted_of(argc, argv, bench::pedicles().size());
  bench::Report report("recognition by the SIMULATED hand");
  auto filled = trials_of(wanted, Preparation::filled, core::terminal_progress("filled"));
  auto published = trials_of(wanted, Preparation::published, core::terminal_progress("published"));
  std::vector<bench::Tried> certified;
  for (const auto& one : filled)
    if (one.passes && one.chosen && one.noise == 1.0) certified.push_back(one);
  fmt::print("\nfilled, walls that pass\n");
  bench::print_table(certified);
  fmt::print("published, every wall\n");
  bench::print_table(published);
  auto every = filled;
  every.insert(every.end(), published.begin(), published.end());
  if (!wanted.scatter.empty()) bench::write_scatter(wanted.scatter, every);
  const int trials = shares(certified, false, &bench::Tried::trials),
            right = shares(certified, false, &bench::Tried::right),
            whole = shares(certified, true, &bench::Tried::trials),
            whole_right = shares(certified, true, &bench::Tried::right);
  report.row("trials, filled, walls that pass", trials, "");
  report.at_least("share right", double(right) / trials, 0.85, "");
  report.at_most("false alarms", double(whole - whole_right) / whole, 0.10, "");
  report.at_least("r of rate and foretold rate, filled and published", bench::correlation(every),
                  0.8, "");
  report.row("at most, with so few trials a form", bench::highest_correlation(every), "");
  report.row("r, filled alone", bench::correlation(filled), "");
  report.row("at most", bench::highest_correlation(filled), "");
  return report.finish(argc, argv);
}
