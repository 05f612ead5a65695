/// `tractus scenario`: makes, checks and draws what the probing rig renders.
#include "scenarios/scenario.hpp"

#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/scenario_picture.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "plot/figure.hpp"
#include "scenarios/demand.hpp"
#include "scenarios/version.hpp"

namespace tractus {
namespace commands {
namespace {
using core::Errc;
using core::Error;
using core::Json;
using scenarios::Scenario;

struct ScenarioOptions {
  std::string kind = "hard", from, name, who, file, out;
  std::vector<std::string> changes;
  std::vector<double> speeds_mm_s{2.0, 5.0, 10.0};
  bool json = false;
};

Outcome make_new(const ScenarioOptions& o) {
  std::error_code ignored;
  if (std::filesystem::exists(o.out, ignored))
    return Error{Errc::conflict,
                 fmt::format("{}: exists already; a version is never overwritten", o.out)};
  const auto parent =
      TRY(o.from.empty() ? scenarios::tuned(*core::from_name<scenarios::Kind>(o.kind))
                         : Scenario::read(o.from));
  std::vector<scenarios::Change> changes;
  if (!o.name.empty()) changes.push_back({"name", o.name});
  for (const std::string& text : o.changes) {
    auto change = scenarios::parse_change(text);
    if (!change) return Error{change.error().code, "--set " + change.error().what};
    changes.push_back(std::move(*change));
  }
  const auto made = scenarios::next_version(parent, changes, o.who, core::utc_us());
  if (!made) return Error{made.error().code, fmt::format("{}: {}", o.out, made.error().what)};
  TRY(core::write_json(o.out, made->to_json()));
  if (o.json)
    fmt::print("{}\n",
               Json{{"file", o.out}, {"id", made->id()}, {"parent", made->origin.parent}}.dump(2));
  else
    fmt::print("{}: {} ({}), version {:.12}\n", o.out, made->name, scenarios::name(made->kind),
               made->id());
  return 0;
}

Json json_of(const Scenario& scenario, const scenarios::Demand& demand) {
  Json pushes = Json::array(), walls = Json::array();
  for (const auto& push : demand.pushes)
    pushes.push_back(
        {{"speed_m_s", push.speed_m_s}, {"mean_N", push.mean_N}, {"peak_N", push.peak_N}});
  for (const auto& wall : demand.walls)
    walls.push_back({{"position_m", wall.position_m},
                     {"threshold_N", wall.threshold_N},
                     {"behind_N", wall.behind_N},
                     {"speed_behind_m_s", wall.speed_m_s},
                     {"thrust_there_N", wall.thrust_N}});
  return {{"name", scenario.name},        {"kind", scenarios::name(scenario.kind)},
          {"id", scenario.id()},          {"parent", scenario.origin.parent},
          {"who", scenario.origin.who},   {"when", scenario.origin.when},
          {"pushes", std::move(pushes)},  {"walls", std::move(walls)},
          {"excessive", demand.excessive}};
}

void print(const Scenario& scenario, const scenarios::Demand& demand) {
  fmt::print("{} ({}), version {:.12}, {} {}\n", scenario.name, scenarios::name(scenario.kind),
             scenario.id(), scenario.origin.who, scenario.origin.when);
  for (const auto& push : demand.pushes)
    fmt::print("at {:4.0f} mm/s   {:5.1f} N in the mean, {:5.1f} N at most\n", 1e3 * push.speed_m_s,
               push.mean_N, push.peak_N);
  for (const auto& wall : demand.walls)
    fmt::print(
        "wall at {:4.1f} mm  breaks at {:.1f} N, {:.1f} N behind it; {:.3f} m/s if the push "
        "stays, where the actuator has {:.0f} N\n",
        1e3 * wall.position_m, wall.threshold_N, wall.behind_N, wall.speed_m_s, wall.thrust_N);
  for (const auto& sentence : demand.excessive) fmt::print("too much: {}\n", sentence);
}

Outcome check(const ScenarioOptions& o) {
  const auto scenario = TRY(Scenario::read(o.file));
  const auto demand = TRY(scenarios::demand(scenario));
  if (o.json)
    fmt::print("{}\n",
               json_of(scenario, demand).dump(2, ' ', false, Json::error_handler_t::replace));
  else
    print(scenario, demand);
  return demand.excessive.empty() ? 0 : 1;
}

Outcome draw(const ScenarioOptions& o) {
  const auto scenario = TRY(Scenario::read(o.file));
  std::vector<double> speeds_m_s;
  for (const double speed : o.speeds_mm_s) speeds_m_s.push_back(1e-3 * speed);
  const auto figure = TRY(scenario_picture(scenario, speeds_m_s));
  TRY(core::write_file(o.out, core::bytes_of(plot::svg(figure))));
  if (o.json)
    fmt::print("{}\n", Json{{"file", o.out}, {"id", scenario.id()}}.dump(2));
  else
    fmt::print("Written to {}\n", o.out);
  return 0;
}

void add_new(CLI::App& app, ScenarioOptions& o) {
  auto* kind = app.add_option("--kind", o.kind, "start from the tuned scenario of this kind")
                   ->check(CLI::IsMember({"hard", "soft", "lateral_breach", "in_out_in"}))
                   ->capture_default_str();
  app.add_option("--from", o.from,
                 "file of a version to start from; this version becomes the parent")
      ->excludes(kind);
  app.add_option("--name", o.name,
                 "name of the new version (default: name of the version to start from)");
  app.add_option("--set", o.changes,
                 "FIELD=VALUE: new value of a field in SI units, for example "
                 "bone/stiffness_N_per_m=9000; may be repeated");
  app.add_option("--who", o.who,
                 "name of the person who tunes the scenario; it is written into the version")
      ->required();
  app.add_option("--out", o.out, "file of the new version; it must not exist")->required();
}

}  // namespace

Command scenario_command() {
  return {"scenario", "Make, check or draw a scenario of the probing rig",
          "tractus scenario new --kind lateral_breach --set density=0.8 --who 'R. Zeller' --out "
          "mine.json\n  tractus scenario check mine.json\n  tractus scenario plot mine.json --out "
          "mine.svg",
          [](CLI::App& app) {
            auto options = std::make_shared<ScenarioOptions>();
            app.require_subcommand(1);
            CLI::App* make =
                app.add_subcommand("new", "make a new version, with author, time and parent");
            CLI::App* look =
                app.add_subcommand("check",
                                   "check a scenario; exit code 0: a surgeon and the actuator can "
                                   "do it, 1: they cannot, 2: the file is invalid");
            CLI::App* plot = app.add_subcommand("plot", "draw resistance against depth, as SVG");
            add_new(*make, *options);
            for (CLI::App* each : {look, plot})
              each->add_option("FILE", options->file,
                               "file of a scenario in the format tractus-scenario/1")
                  ->required();
            plot->add_option("--speed", options->speeds_mm_s,
                             "speed of the tip, in mm/s; may be repeated")
                ->check(CLI::Range(0.0, 230.0))
                ->capture_default_str();
            plot->add_option("--out", options->out, "SVG file to write")->required();
            for (CLI::App* each : {make, look, plot})
              each->add_flag("--json", options->json, "print the result as JSON");
            return [options, make, look]() -> Outcome {
              if (make->parsed()) return make_new(*options);
              return look->parsed() ? check(*options) : draw(*options);
            };
          }};
}

}  // namespace commands
}  // namespace tractus
