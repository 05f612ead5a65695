#include "probing/write.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace blind {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

bool put(const fs::path& file, const Json& json) {
  std::ofstream out(file);
  out << json.dump(1) << '\n';
  return static_cast<bool>(out.flush());
}

Json base_json(const Base& base) {
  Json layers = Json::array();
  for (const Layer& l : base.layers)
    layers.push_back({{"start_m", l.start_m},
                      {"thickness_m", l.thickness_m},
                      {"stiffness_N_per_m", l.stiffness_N_per_m},
                      {"damping_Ns_per_m", l.damping_Ns_per_m},
                      {"equilibrium_m", l.equilibrium_m}});
  return {{"layers", layers},
          {"rotary",
           {{"viscous_Nms_per_rad", base.rotary.viscous_Nms_per_rad},
            {"detent_Nm", base.rotary.detent_Nm},
            {"detent_pitch_rad", base.rotary.detent_pitch_rad}}}};
}

bool put_trial(const fs::path& file, const Samples& s, bool rotation) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) return false;
  std::fputs(rotation ? "t_s,x_m,theta_rad,fz_N,tz_Nm\n" : "t_s,x_m,fz_N\n", out);
  for (std::size_t i = 0; i < s.t_s.size(); ++i) {
    if (rotation)
      std::fprintf(out, "%.6f,%.10g,%.8g,%.8g,%.8g\n", s.t_s[i], s.x_m[i], s.theta_rad[i],
                   s.force_N[i], s.torque_Nm[i]);
    else
      std::fprintf(out, "%.6f,%.10g,%.8g\n", s.t_s[i], s.x_m[i], s.force_N[i]);
  }
  return std::fclose(out) == 0;
}

const char* name_of(Mode mode) {
  return mode == Mode::kHand ? "hand" : mode == Mode::kPlayedHand ? "played hand" : "programmed";
}

Json effects_json(const GeneratedSet& set) {
  Json out = Json::array();
  for (std::size_t i = 0; i < set.plan.effects.size(); ++i) {
    const Outcome& o = set.outcomes[i];
    out.push_back({{"id", set.plan.effects[i].id},
                   {"parameters", set.plan.effects[i].parameters},
                   {"rms", o.rms_N},
                   {"strength", o.strength},
                   {"projected_rms", o.projected_N}});
  }
  return out;
}

}  // namespace

bool write_set(const GeneratedSet& set, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "measurements", error);
  if (error) return false;
  const SuppliedBase& supplied = set.plan.supplied;
  Json model = {{"format", "tractus-model/1"},
                {"rig", "probing"},
                {"name", "supplied base model (simulated set)"},
                {"base", base_json(supplied.base)}};
  if (!supplied.fixed.empty()) model["fixed"] = supplied.fixed;
  model["effects"] = Json::array();
  Json trials = Json::array();
  bool good = put(folder / "model.json", model);
  for (std::size_t i = 0; i < set.trials.size(); ++i) {
    const std::string id = "trial" + std::to_string(i + 1);
    trials.push_back({{"id", id}, {"file", id + ".csv"}, {"operator", "simulated"}, {"notes", ""}});
    good = put_trial(folder / "measurements" / (id + ".csv"), set.trials[i],
                     set.plan.recording.rotation_channels) &&
           good;
  }
  return put(folder / "measurements" / "set.json",
             {{"format", "tractus-measurements/1"}, {"rig", "probing"}, {"trials", trials}}) &&
         good;
}

bool write_truth(const GeneratedSet& set, const fs::path& file) {
  const SetPlan& plan = set.plan;
  Json modes = Json::array();
  for (const TrialPlan& trial : plan.trials) modes.push_back(name_of(trial.mode));
  return put(
      file,
      {{"format", "blind-truth/1"},
       {"rig", "probing"},
       {"seed", plan.request.seed},
       {"accepted", set.accepted},
       {"kind", plan.kind},
       {"effects", effects_json(set)},
       {"projected_rms", set.hidden_projected_N},
       {"force_rms", set.force_rms_N},
       {"floor", set.floor_N},
       {"attainable", set.attainable_N},
       {"attainable_away", set.attainable_away_N},
       {"stuck_share", set.stuck_share},
       {"supplied", plan.supplied.how},
       {"fixed", plan.supplied.fixed},
       {"modes", modes},
       {"averaging", plan.recording.averaging},
       {"rotation_channels", plan.recording.rotation_channels},
       {"air", std::ranges::any_of(plan.trials, [](const TrialPlan& t) { return t.air_s > 0; })},
       {"base", base_json(plan.truth)}});
}

}  // namespace blind
