/// Can the breaches of real cases be felt? Each wall of each pedicle by the certificate, in
/// published and in filled bone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bench/feelability/pedicles.hpp"
#include "bench/support/report.hpp"

namespace tractus {
namespace {

using volume::Preparation;
using volume::Wall;

models::PalpationModel published_model() {
  models::PalpationModel model;
  model.name = "uniform cantilever";
  return model;
}

std::string cell(const cases::WallCertificate& wall) {
  const auto number = [](const std::optional<double>& x) {
    return x ? fmt::format("{:.1f}", *x) : std::string("–");
  };
  if (!wall.at_m) return fmt::format("{:>21}", "not tried");
  const std::string text =
      wall.wall == Wall::anterior
          ? fmt::format("{} {:.2f} N", number(wall.told.k), wall.end_force_N)
          : fmt::format("{} {} {} {:2.0f} {:2.0f}%", number(wall.told.k), number(wall.told.b),
                        number(wall.told.fa), *wall.at_m * 1e3, 100.0 * wall.foretold);
  return fmt::format("{:>20}{}", text, wall.passes() ? '*' : ' ');
}

void row(const std::string& name, const core::Result<cases::Made>& made) {
  if (!made) return fmt::print("{:28} {}\n", name, made.error().what);
  fmt::print("{:28}", name);
  for (const auto& wall : made->certificate->walls) fmt::print("{}", cell(wall));
  fmt::print(" {:4.1f} mm{}\n", made->tract.length_m * 1e3,
             made->moved_m.norm() > 0.0
                 ? fmt::format(", moved {:.1f} mm to medial, {:.1f} to superior",
                               made->moved_m.x() * 1e3, made->moved_m.y() * 1e3)
                 : "");
  std::fflush(stdout);
}

/// Every place that was tried, for whoever asks why a wall fails.
void print_places(const core::Result<cases::Made>& made) {
  if (!made) return;
  for (const auto& wall : made->certificate->walls)
    for (const auto& place : wall.places)
      fmt::print(
          "    {:9} {:4.0f} mm  K {:5.2f}  B {:5.2f}  FA {:5.2f} ({} {:.0f} mm)  lean {:.2f} "
          "mm {} {}\n",
          name(wall.wall), place.at_m * 1e3, place.told.k.value_or(NAN), place.told.b.value_or(NAN),
          place.told.fa.value_or(NAN), place.told.fa_wall ? name(*place.told.fa_wall) : "",
          place.told.fa_at_m * 1e3, place.told.lean_m * 1e3,
          place.told.motion ? name(*place.told.motion) : "",
          place.told.contrast ? name(*place.told.contrast) : "");
}

/// Time to a certificate of a plan as it is, s.
double certifying_s(const volume::Volume& ct, const cases::CarvingPlan& plan,
                    cases::Effort effort) {
  const double start_s = bench::wall_s();
  const auto found = cases::certify(ct, published_model(), plan, effort);
  return found ? bench::wall_s() - start_s : 0.0;
}

bool flag(int argc, char** argv, const char* name) {
  return std::any_of(argv + 1, argv + argc, [&](const char* a) { return !std::strcmp(a, name); });
}

double option(int argc, char** argv, const char* name, double otherwise) {
  for (int k = 1; k + 1 < argc; ++k)
    if (std::strcmp(argv[k], name) == 0) return std::atof(argv[k + 1]);
  return otherwise;
}

}  // namespace
}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("feelability of real cases");
  fmt::print(
      "K B FA, depth in mm, share right that is foretold; * the wall passes; anterior: K and the "
      "end's force\n{:28}",
      "");
  for (const Wall wall : volume::kWalls) fmt::print("{:>21}", name(wall));
  fmt::print("\n");
  double least_side = 1e300, least_over_false = 1e300, least_end = 1e300, slowest_s = 0.0,
         first_s = 0.0, whole_s = 0.0, filled_pedicles = 0.0, passed = 0.0, walls = 0.0;
  const auto all = bench::pedicles();
  const auto count = std::size_t(option(argc, argv, "--pedicles", double(all.size())));
  const auto first = std::size_t(option(argc, argv, "--from", 0.0));
  for (std::size_t n = first; n < std::min(count, all.size()); ++n) {
    const auto& pedicle = all[n];
    const auto& ct = bench::ct_of(pedicle);
    fmt::print("{}\n", pedicle.name);
    if (!flag(argc, argv, "--filled-only"))
      row("  published", cases::make(ct, published_model(), pedicle.plan(Preparation::published)));
    auto plan = pedicle.plan(Preparation::filled);
    first_s = std::max(first_s, certifying_s(ct, plan, cases::Effort::first));
    whole_s = std::max(whole_s, certifying_s(ct, plan, cases::Effort::whole));
    const double start_s = bench::wall_s();
    plan.may_move_m = option(argc, argv, "--move", 2.0) * 1e-3;
    const auto filled = cases::make(ct, published_model(), plan);
    slowest_s = std::max(slowest_s, bench::wall_s() - start_s);
    row("  filled", filled);
    if (flag(argc, argv, "--places")) print_places(filled);
    if (!filled) continue;
    filled_pedicles += 1.0;
    for (const auto& wall : filled->certificate->walls) {
      passed += wall.passes(), walls += 1.0;
      const double d = wall.d_prime().value_or(0.0);
      if (wall.wall == Wall::anterior) {
        least_end = std::min(least_end, d);
      } else {
        least_side = std::min(least_side, d);
        least_over_false =
            std::min(least_over_false, wall.told.b.value_or(0.0) - wall.told.fa.value_or(0.0));
      }
    }
  }
  report.at_least("pedicles that could be filled", filled_pedicles, 8, "");
  report.row("filled: walls that pass", passed / walls, "");
  report.at_least("filled: min(K, B) of every side wall", least_side, 2.5, "");
  report.at_least("filled: B − FA of every side wall", least_over_false, 0.5, "");
  report.at_least("filled: K of every end", least_end, 2.0, "");
  report.at_most("slowest first answer of a certificate", first_s, 2.0, "s");
  report.at_most("slowest whole certificate of a plan", whole_s, 20.0, "s");
  report.row("slowest making, moves tried", slowest_s, "s");
  return report.finish(argc, argv);
}
