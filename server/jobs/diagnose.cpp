#include "server/jobs/diagnose.hpp"

#include <chrono>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "db/store/cases.hpp"
#include "db/store/lab.hpp"
#include "lab/io/answers.hpp"

namespace jobs {
namespace {

using core::Errc;
using core::Error;
using core::Result;

struct Asked {
  store::DiagnosisRun run;
  store::ModelVersion model;
  store::MeasurementSet set;
};

Result<Asked> asked(store::Store& store, const std::string& id) {
  return store.read([&](store::Reading& tx) -> Result<Asked> {
    const auto run = store::diagnosis_of(tx, id);
    if (!run) return run.error();
    if (!*run) return Error{Errc::not_found, "no diagnosis " + id.substr(0, 64)};
    const auto model = store::model_of(tx, (*run)->model_id);
    if (!model) return model.error();
    const auto set = store::measurement_set_of(tx, (*run)->set_id);
    if (!set) return set.error();
    if (!*model || !*set) return Error{Errc::not_found, "its model or its measurements are gone"};
    return Asked{**run, **model, **set};
  });
}

/// Notes progress now and then, and hears of those who want it to stop.
core::Progress watched(store::Store& store, const std::string& id,
                       const std::function<bool()>& ending) {
  using Clock = std::chrono::steady_clock;
  auto next = std::make_shared<Clock::time_point>(Clock::now());
  return [&store, id, ending, next](double share) {
    if (ending()) return false;
    if (Clock::now() < *next) return true;
    *next = Clock::now() + std::chrono::milliseconds(500);
    const auto stop = store.write([&](store::Writing& tx) {
      return store::note_diagnosis_share(tx, id, share, core::utc_us());
    });
    return !stop || !*stop;  // a database that is busy for once stops nothing
  };
}

struct Kept {
  std::string sha256;
  std::uint64_t size = 0;
};

Result<Kept> keep(const store::Objects& objects, const std::string& text) {
  auto sha256 = objects.put(core::bytes_of(text));
  if (!sha256) return sha256.error();
  return Kept{*sha256, text.size()};
}

Result<void> record(store::Store& store, const Asked& of, const std::vector<Kept>& kept,
                    bool better) {
  return store.write([&](store::Writing& tx) -> Result<void> {
    const std::int64_t now = core::utc_us();
    for (const Kept& one : kept)
      if (auto added = store::add_object(tx, one.sha256, one.size, now); !added) return added;
    if (better) {
      const store::ModelVersion version{
          core::new_id(), of.model.name, of.model.rig, kept[2].sha256,
          of.model.id,    of.run.id,     now,          of.run.made_by};
      if (auto added = store::add_model(tx, version); !added) return added;
    }
    return store::finish_diagnosis(tx, of.run.id, kept[0].sha256, kept[1].sha256, now);
  });
}

}  // namespace

Result<void> diagnose(store::Store& store, const store::Objects& objects,
                      const std::string& diagnosis_id, const std::function<bool()>& ending) {
  const auto of = asked(store, diagnosis_id);
  if (!of) return of.error();
  if (of->run.state != "queued" && of->run.state != "running") return {};
  const auto progress = watched(store, diagnosis_id, ending);
  if (!progress(0.0)) return Error{Errc::cancelled, "stopped"};
  const auto opened = lab_io::open_case({.model = objects.path_of(of->model.sha256),
                                         .measurements = objects.path_of(of->set.id),
                                         .threads = 1},
                                        lab_io::part_of(progress, 0.0, 0.3));
  if (!opened) return opened.error();
  lab_io::DiagnoseWish wish{.options = {}, .report = true};
  wish.options.threads = 1;  // the other processors are the requests'
  auto answer = lab_io::diagnosed(*opened, wish, lab_io::part_of(progress, 0.3, 0.7));
  if (!answer) return answer.error();
  answer->content.set_name = of->set.name;
  std::vector<Kept> kept;
  for (const std::string& text :
       {answer->json.dump(2) + "\n", lab::report(answer->content), answer->model->dump(2) + "\n"}) {
    auto one = keep(objects, text);
    if (!one) return one.error();
    kept.push_back(*one);
  }
  return record(store, *of, kept, !answer->content.diagnosis->effects.empty());
}

}  // namespace jobs
