/// `tractus analyse`: a plan locked before the data are seen, run on a frozen snapshot.
#include "assessment/analyse.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "assessment/plan_page.hpp"
#include "assessment/snapshot.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

namespace fs = std::filesystem;
using assessment::Plan;
using core::Json;

struct AnalyseOptions {
  std::string plan, data, out, who, name, source, against;
  std::vector<std::string> meanings;
  bool data_seen = false, simulated = false, json = false;
};

void print(const Json& json) {
  std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

core::Result<void> refuse_existing(const fs::path& path) {
  if (!fs::exists(path)) return {};
  return core::Error{core::Errc::conflict, path.string() + ": exists already"};
}

Outcome make_new(const AnalyseOptions& o) {
  TRY(refuse_existing(o.plan));
  TRY(core::write_json(o.plan, assessment::example_plan()));
  std::printf("%s: a plan to edit; then: tractus analyse lock %s --who NAME\n", o.plan.c_str(),
              o.plan.c_str());
  return 0;
}

Outcome lock(const AnalyseOptions& o) {
  const auto json = TRY(core::read_json(o.plan));
  const assessment::Lock by{o.who, core::utc_text(core::utc_us()), o.data_seen, ""};
  const auto locked = TRY(assessment::locked(json, o.plan, by));
  TRY(core::write_json(o.plan, locked));
  if (o.json)
    print(locked["lock"]);
  else
    std::printf("%s: locked by %s on %s, SHA-256 %s\n", o.plan.c_str(), by.who.c_str(),
                by.utc.c_str(), locked["lock"]["sha256"].get<std::string>().c_str());
  return 0;
}

Outcome freeze(const AnalyseOptions& o) {
  TRY(refuse_existing(o.out));
  auto data = TRY(core::read_file(o.data, 512ull << 20));
  assessment::Freezing by{o.name.empty() ? fs::path(o.data).filename().string() : o.name,
                          core::utc_text(core::utc_us()),
                          o.source,
                          o.simulated,
                          {}};
  for (const auto& meaning : o.meanings) {
    const auto at = meaning.find('=');
    if (at == std::string::npos)
      return core::bad_input(fmt::format("--meaning '{}': COLUMN=TEXT is expected", meaning));
    by.meanings[meaning.substr(0, at)] = meaning.substr(at + 1);
  }
  const auto snapshot = TRY(assessment::frozen(std::move(data), by));
  TRY(assessment::write(snapshot, o.out));
  if (o.json)
    print(snapshot.description);
  else
    std::printf("%s: %zu rows, %zu columns, SHA-256 %s\n", o.out.c_str(), snapshot.table.rows(),
                snapshot.table.columns().size(), snapshot.sha256().c_str());
  return 0;
}

struct Ran {
  assessment::Snapshot snapshot;
  assessment::Analysed analysed;
};

core::Result<Ran> ran(const AnalyseOptions& o) {
  const auto json = TRY(core::read_json(o.plan));
  const auto plan = TRY(Plan::from_json(json, o.plan));
  TRY(assessment::check_lock(plan, o.plan));
  auto snapshot = TRY(assessment::Snapshot::read(o.data));
  const auto& d = snapshot.description;
  auto analysed = TRY(assessment::analyse(plan, snapshot.table,
                                          {d["name"], snapshot.sha256(), d["frozen_utc"],
                                           d.value("source", ""), d.value("simulated", false)},
                                          core::terminal_progress("analyse")));
  return Ran{std::move(snapshot), std::move(analysed)};
}

std::string text_of(const Json& result) {
  return result.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print_results(const Json& result) {
  std::printf("%s\n", result["plan"]["title"].get<std::string>().c_str());
  for (const auto& one : result["results"]) std::printf("  %s\n", one.get<std::string>().c_str());
  for (const auto& one : result["published"])
    if (one.contains("agrees") && one["agrees"] == false)
      std::printf("  published, %s: %s; computed %s\n", one["where"].get<std::string>().c_str(),
                  one["printed"].dump().c_str(), one["computed"].dump().c_str());
}

Outcome run_analyse(const AnalyseOptions& o) {
  const auto done = TRY(ran(o));
  const std::string text = text_of(done.analysed.result);
  if (!o.out.empty()) TRY(core::write_file(o.out, core::bytes_of(text)));
  if (o.json)
    std::fputs(text.c_str(), stdout);
  else
    print_results(done.analysed.result);
  if (o.against.empty()) return 0;
  const auto before = TRY(core::read_file(o.against, 512ull << 20));
  const bool same = core::text_of(before) == text;
  std::fprintf(stderr, "%s: %s\n", o.against.c_str(),
               same ? "the same to the last digit" : "NOT the same");
  return same ? 0 : 1;
}

Outcome report(const AnalyseOptions& o) {
  TRY(refuse_existing(o.out));
  const auto done = TRY(ran(o));
  auto scratch = TRY(core::ScratchFolder::make(o.out));
  const std::pair<const char*, std::string> files[] = {
      {"report.html", assessment::report_page(done.analysed)},
      {"result.json", text_of(done.analysed.result)},
      {"data.csv", assessment::marked(done.snapshot.table, done.analysed.excluded_because)},
      {"dictionary.json", text_of(assessment::dictionary_of_marked(done.snapshot.description))}};
  for (const auto& [name, text] : files)
    TRY(core::write_file(scratch.path() / name, core::bytes_of(text)));
  TRY(scratch.keep_as(o.out));
  if (o.json)
    print({{"folder", o.out},
           {"files", {"report.html", "result.json", "data.csv", "dictionary.json"}}});
  else
    std::printf("%s: report.html, result.json, data.csv, dictionary.json\n", o.out.c_str());
  return 0;
}

using Action = Outcome (*)(const AnalyseOptions&);

CLI::App* add(CLI::App& app, const char* name, const char* summary, Action action,
              const std::shared_ptr<Action>& chosen) {
  CLI::App* sub = app.add_subcommand(name, summary);
  sub->callback([=] { *chosen = action; });
  return sub;
}

void add_actions(CLI::App& app, const std::shared_ptr<AnalyseOptions>& o,
                 const std::shared_ptr<Action>& chosen) {
  auto* fresh = add(app, "new", "Write a template of an analysis plan", make_new, chosen);
  auto* locking =
      add(app, "lock", "Lock a plan: add author, time and a hash of its contents", lock, chosen);
  auto* freezing = add(app, "freeze", "Freeze a CSV file as a snapshot with dictionary and hash",
                       freeze, chosen);
  auto* running = add(app, "run", "Run a locked plan on a frozen snapshot", run_analyse, chosen);
  auto* reporting =
      add(app, "report", "Run a locked plan and write report page, result, data and dictionary",
          report, chosen);
  for (CLI::App* sub : {fresh, locking, running, reporting})
    sub->add_option("PLAN", o->plan, "plan file in the format tractus-plan/1")->required();
  locking->add_option("--who", o->who, "name of the person who locks the plan")->required();
  locking->add_flag("--data-seen", o->data_seen,
                    "the author already knows the data: the analysis is a reanalysis");
  freezing->add_option("DATA", o->data, "CSV file, one row per trial")->required();
  freezing->add_option("FOLDER", o->out, "folder of the snapshot; it must not exist")->required();
  freezing->add_option("--name", o->name, "name of the data");
  freezing->add_option("--source", o->source, "origin of the data and their licence");
  freezing->add_option("--meaning", o->meanings,
                       "COLUMN=TEXT: meaning of a column; may be repeated");
  freezing->add_flag("--simulated", o->simulated, "the data are simulated");
  for (CLI::App* sub : {running, reporting})
    sub->add_option("SNAPSHOT", o->data, "folder of a snapshot that 'freeze' made")->required();
  running->add_option("--out", o->out, "file for the result, as JSON");
  running->add_option(
      "--against", o->against,
      "file of an earlier result; the exit code is 1 if the new result differs in any digit");
  reporting->add_option("FOLDER", o->out, "folder of the report; it must not exist")->required();
  for (CLI::App* sub : {locking, freezing, running, reporting})
    sub->add_flag("--json", o->json, "print as JSON");
}

}  // namespace

Command analyse_command() {
  return {"analyse",
          "Lock an analysis plan, run it on a frozen snapshot of a cohort, and write the report",
          "tractus analyse new plan.json                     # edit it, then\n"
          "  tractus analyse lock plan.json --who \"A. Author\"\n"
          "  tractus analyse freeze trials.csv cohort/\n"
          "  tractus analyse run plan.json cohort/ --out result.json\n"
          "  tractus analyse report plan.json cohort/ report/",
          [](CLI::App& app) {
            auto options = std::make_shared<AnalyseOptions>();
            auto chosen = std::make_shared<Action>(nullptr);
            app.require_subcommand(1);
            add_actions(app, options, chosen);
            return [options, chosen]() -> Outcome { return (*chosen)(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
