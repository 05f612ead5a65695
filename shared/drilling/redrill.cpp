#include "drilling/redrill.hpp"

#include <fmt/format.h>

#include "core/try.hpp"

namespace tractus {
namespace drilling {
namespace {

using core::Errc;
using core::Error;
using core::Json;

core::Result<volume::TransferFunction> transfer_of(const Json& points, const std::string& where) {
  std::vector<volume::TransferFunction::Point> out;
  for (const Json& point : points.is_array() ? points : Json::array()) {
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      return Error{Errc::bad_input, where + ": pairs of value and opacity are expected"};
    out.push_back({point[0].get<double>(), point[1].get<double>()});
  }
  auto made = volume::TransferFunction::make(std::move(out));
  if (!made) return Error{made.error().code, where + ": " + made.error().what};
  return made;
}

}  // namespace

Json Setup::to_json() const {
  Json points = Json::array();
  for (const auto& point : transfer.points())
    points.push_back(Json::array({point.value, point.opacity}));
  return {{"law", kLaw},
          {"chunk_ticks", kChunkTicks},
          {"burr", burr.to_json()},
          {"transfer", std::move(points)}};
}

core::Result<Setup> Setup::of(const trial::Header& header) {
  const auto found = header.extra.find("drilling");
  if (found == header.extra.end() || !found->is_object())
    return Error{Errc::bad_input, "the trial is not one of drilling: its header has no burr"};
  const std::string where = "header: /extra/drilling";
  core::Fields fields(*found, where);
  if (fields.text("law") != kLaw)
    fields.wrong("law", std::string(kLaw) + " is expected: no other law is known");
  fields.integer("chunk_ticks", kChunkTicks, kChunkTicks);
  const Json *burr = fields.member("burr"), *points = fields.member("transfer");
  TRY(fields.done());
  auto made = TRY(Burr::from_json(*burr, where + "/burr"));
  auto transfer = TRY(transfer_of(*points, where + "/transfer"));
  return Setup{made, std::move(transfer)};
}

std::optional<bool> Redrilled::agrees() const {
  if (!said.is_object()) return std::nullopt;
  const auto hash = said.find("counts_sha256");
  return hash != said.end() && *hash == Json(drilled_of(erosion).sha256());
}

core::Result<Redrilled> redrill(
    const std::filesystem::path& trial_file, const volume::Volume& bone,
    const std::function<void(const trial::Sample&)>& on_sample,
    const std::function<void(const Change&, const volume::Volume&)>& changed) {
  const auto scanned = TRY(trial::scan_trial(trial_file, [](const trial::Block&) {}));
  const auto named = [&](const Error& error) {
    return Error{error.code, trial_file.string() + ": " + error.what};
  };
  const auto setup = Setup::of(scanned.header);
  if (!setup) return named(setup.error());
  const auto probe = trial::probe_shape(scanned.header);
  if (!probe) return named({Errc::bad_input, "the header's probe has no length"});
  auto erosion = Erosion::make(bone, setup->transfer, setup->burr, *probe);
  if (!erosion) return named(erosion.error());

  const Erosion::Take take = [&](const Change& change) {
    if (changed) changed(change, erosion->volume());
  };
  const auto read = TRY(trial::scan_trial(trial_file, [&](const trial::Block& block) {
    for (const trial::Sample& sample : block.palpation) {
      if (on_sample) on_sample(sample);
      erosion->add(sample, take);
    }
  }));
  erosion->finish(take);
  Redrilled out{read.header, std::move(*erosion), Json()};
  for (const trial::Event& event : read.events)
    if (event.is(trial::EventKind::drilled)) out.said = event.detail;
  return out;
}

}  // namespace drilling
}  // namespace tractus
