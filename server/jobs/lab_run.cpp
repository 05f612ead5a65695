#include "server/jobs/lab_run.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/lab/lab.hpp"
#include "lab/io/answers.hpp"
#include "lab/io/kept_samples.hpp"
#include "lab/report/answer.hpp"
#include "server/jobs/lab_progress.hpp"

namespace tractus {
namespace jobs {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

struct Asked {
  store::LabRun run;
  store::ModelVersion model;
  std::optional<store::ModelVersion> against;
  store::MeasurementSet set;
};

Result<store::ModelVersion> version_of(store::Reading& tx, const std::string& id) {
  auto model = TRY(store::model_of(tx, id));
  if (!model) return Error{Errc::not_found, "the model no longer exists"};
  return *model;
}

Result<Asked> asked(store::Store& store, const std::string& id) {
  return store.read([&](store::Reading& tx) -> Result<Asked> {
    const auto run = TRY(store::lab_run_of(tx, id));
    if (!run) return Error{Errc::not_found, "no run " + id.substr(0, 64)};
    const auto model = TRY(version_of(tx, run->model_id));
    const auto set = TRY(store::measurement_set_of(tx, run->set_id));
    if (!set) return Error{Errc::not_found, "the measurement set no longer exists"};
    Asked out{*run, model, std::nullopt, *set};
    if (!out.run.against_id) return out;
    auto against = TRY(version_of(tx, *out.run.against_id));
    out.against = std::move(against);
    return out;
  });
}

/// What the page's processes leave free: half of the processors.
int threads() { return std::max(1, int(std::thread::hardware_concurrency()) / 2); }

struct Wish {
  std::vector<std::string> add;
  std::vector<lab_io::OwnEffect> own;
};

Wish wish_of(const store::LabRun& run) {
  Wish out;
  const Json json = core::stored_json(run.wish);
  if (!json.is_object()) return out;
  for (const Json& id : json.value("add", Json::array())) out.add.push_back(id.get<std::string>());
  for (const Json& own : json.value("own", Json::array())) out.own.push_back({own, "own effect: "});
  return out;
}

/// What a run comes to, before it is kept.
struct Outcome {
  Json result = {{"diagnosis", nullptr}, {"fit", nullptr}, {"comparisons", nullptr}};
  std::string report, samples;
  std::optional<Json> model;
};

class LabRun {
 public:
  LabRun(store::Store& store, const store::Objects& objects, const Asked& of,
         const std::function<bool()>& ending)
      : store_(store),
        objects_(objects),
        of_(of),
        wish_(wish_of(of.run)),
        watch_(store, of.run.id, ending) {}

  Result<Outcome> work() {
    if (!watch_.at("reading the measurements", 0.0, 1.0)(0.0))
      return Error{Errc::cancelled, "stopped"};
    if (of_.run.kind == store::LabRunKind::comparison) return compare();
    return of_.run.kind == store::LabRunKind::fit ? fit() : diagnose();
  }

 private:
  Result<lab_io::Case> opened(const store::ModelVersion& model, double from, double width,
                              bool keep_recordings = false) {
    return lab_io::open_case({.model = TRY(objects_.file(model.sha256)),
                              .measurements = TRY(objects_.file(of_.set.id)),
                              .own = wish_.own,
                              .threads = threads(),
                              .keep_recordings = keep_recordings},
                             watch_.at("reading the measurements", from, width));
  }

  void keep_sides(const lab_io::LabResult& answer, const Json& tract, Outcome& out) const {
    const auto& content = answer.content;
    const auto* after = content.better ? &*content.better : nullptr;
    out.result["comparisons"] = {{"before", lab::to_json(content.before.comparison)},
                                 {"after", after ? lab::to_json(after->comparison) : Json()}};
    out.result["tract_map"] = content.map ? lab::to_json(*content.map) : Json();
    if (content.map) out.result["tract_map"]["tract"] = tract;
    out.samples = lab_io::kept_samples(content.before, after);
  }

  Result<Outcome> compare() {
    const double half = of_.against ? 0.5 : 1.0;
    const auto first = TRY(opened(of_.model, 0.0, 0.9 * half));
    auto answer = lab_io::compared(first);
    if (of_.against) {
      const auto second = TRY(opened(*of_.against, half, 0.9 * half));
      answer.content.better = lab_io::compared(second).content.before;
    }
    Outcome out;
    keep_sides(answer, first.tract, out);
    return out;
  }

  Result<Outcome> fit() {
    const auto opened_case = TRY(opened(of_.model, 0.0, 0.3));
    auto answer =
        TRY(lab_io::fitted(opened_case, wish_.add, threads(), watch_.at("fitting", 0.3, 0.65)));
    return finished("fit", opened_case, std::move(answer));
  }

  Result<Outcome> diagnose() {
    const auto opened_case = TRY(opened(of_.model, 0.0, 0.3, true));
    lab_io::DiagnoseRequest how{.options = {}, .report = true};
    how.programs = lab_io::DiagnoseRequest::Weigh::if_undecided;
    how.options.threads = threads();
    how.options.early = [this](const std::vector<lab::Ranked>& ranking) {
      note_ranking(ranking);
      watch_.say("trying effects together");
    };
    auto answer = TRY(
        lab_io::diagnosed(opened_case, how, watch_.at("trying each effect by itself", 0.3, 0.65)));
    return finished("diagnosis", opened_case, std::move(answer));
  }

  void note_ranking(const std::vector<lab::Ranked>& ranking) {
    const std::string json = lab::to_json(ranking).dump();
    // Only a look ahead: a database that is busy for once loses nothing that the result lacks.
    (void)store_.write(
        [&](store::Writing& tx) { return store::note_lab_ranking(tx, of_.run.id, json); });
  }

  Result<Outcome> finished(const char* kind, const lab_io::Case& opened_case,
                           lab_io::LabResult answer) {
    watch_.say("writing the report");
    answer.content.set_name = of_.set.name;
    Outcome out;
    out.result[kind] = answer.json;
    keep_sides(answer, opened_case.tract, out);
    out.report = lab::report(answer.content);
    out.model = std::move(answer.model);
    return out;
  }

  store::Store& store_;
  const store::Objects& objects_;
  const Asked& of_;
  Wish wish_;
  LabProgress watch_;
};

Result<void> keep(store::Store& store, const store::Objects& objects, store::LabRun run,
                  const Outcome& outcome) {
  std::vector<std::pair<std::string, std::uint64_t>> kept;
  const auto put = [&](const std::string& text, std::optional<std::string>& as) -> Result<void> {
    if (text.empty()) return {};
    auto sha256 = TRY(objects.put(core::bytes_of(text)));
    kept.emplace_back(sha256, text.size());
    as = sha256;
    return {};
  };
  const std::string model = outcome.model ? outcome.model->dump(2) + "\n" : "";
  for (const auto& [text, as] :
       {std::pair{outcome.result.dump() + "\n", &run.result},
        std::pair{outcome.report, &run.report}, std::pair{outcome.samples, &run.samples},
        std::pair{model, &run.model}})
    TRY(put(text, *as));
  return store.write([&](store::Writing& tx) -> Result<void> {
    const std::int64_t now = core::utc_us();
    for (const auto& [sha256, size] : kept) TRY(store::add_object(tx, sha256, size, now));
    return store::finish_lab_run(tx, run, now);
  });
}

}  // namespace

Result<void> run_lab(store::Store& store, const store::Objects& objects, const std::string& run_id,
                     const std::function<bool()>& ending) {
  const auto of = TRY(asked(store, run_id));
  if (of.run.state != store::LabRunState::queued && of.run.state != store::LabRunState::running)
    return {};
  const auto outcome = TRY(LabRun(store, objects, of, ending).work());
  return keep(store, objects, of.run, outcome);
}

}  // namespace jobs
}  // namespace tractus
