#include "palpation/write.hpp"

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

Json base_json(const Probe& p, FieldKind field) {
  return {{"force_factor_Nm", p.force_factor_Nm},
          {"force_scale", p.force_scale},
          {"torque_scale", p.torque_scale},
          {"points", p.points},
          {"point_spacing_m", p.point_spacing_m},
          {"youngs_modulus_Pa", p.youngs_modulus_Pa},
          {"length_m", p.length_m},
          {"radius_m", p.radius_m},
          {"pose_offset_m", {p.offset_m[0], p.offset_m[1], p.offset_m[2]}},
          {"field", field == FieldKind::kPaper ? "paper" : "potential"}};
}

Json fixed_json(const PalpationPlan& plan) {
  Json out = Json::array();
  for (const std::string& name : plan.fixed) out.push_back("/base/" + name);
  return out;
}

bool put_trial(const fs::path& file, const std::vector<PalpationSample>& samples) {
  std::FILE* out = std::fopen(file.c_str(), "w");
  if (out == nullptr) return false;
  std::fputs("t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n", out);
  for (const PalpationSample& s : samples) {
    const Vec3 &f = s.wrench.force_N, &m = s.wrench.torque_Nm;
    std::fprintf(out, "%.6f,%.9g,%.9g,%.9g,%.10g,%.10g,%.10g,%.10g,%.7g,%.7g,%.7g,%.7g,%.7g,%.7g\n",
                 s.t_s, s.p_m[0], s.p_m[1], s.p_m[2], s.q.w(), s.q.x(), s.q.y(), s.q.z(), f[0],
                 f[1], f[2], m[0], m[1], m[2]);
  }
  return std::fclose(out) == 0;
}

Json effects_json(const PalpationSet& set) {
  Json out = Json::array();
  for (std::size_t i = 0; i < set.plan.effects.size(); ++i) {
    Json parameters = Json::object();
    for (const auto& [name, values] : set.plan.effects[i].parameters)
      parameters[name] = values.size() == 1 ? Json(values[0]) : Json(values);
    const PalpationOutcome& o = set.outcomes[i];
    out.push_back({{"id", set.plan.effects[i].id},
                   {"parameters", parameters},
                   {"rms", o.rms_N},
                   {"strength", o.strength},
                   {"projected_rms", o.projected_N}});
  }
  return out;
}

}  // namespace

bool write_set(const PalpationSet& set, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "measurements", error);
  if (error) return false;
  const PalpationPlan& plan = set.plan;
  Json transfer = Json::array();
  for (const auto& [hu, opacity] : plan.transfer) transfer.push_back({hu, opacity});
  bool good = write_nrrd(plan.volume, folder / "volume.nrrd") &&
              put(folder / "model.json", {{"format", "tractus-model/1"},
                                          {"rig", "palpation"},
                                          {"name", "supplied base model (simulated set)"},
                                          {"volume", "volume.nrrd"},
                                          {"transfer", transfer},
                                          {"base", base_json(plan.supplied, plan.field)},
                                          {"fixed", fixed_json(plan)},
                                          {"effects", Json::array()}});
  Json trials = Json::array();
  for (std::size_t i = 0; i < set.trials.size(); ++i) {
    const std::string id = "trial" + std::to_string(i + 1);
    trials.push_back({{"id", id}, {"file", id + ".csv"}, {"operator", "simulated"}, {"notes", ""}});
    good = put_trial(folder / "measurements" / (id + ".csv"), set.trials[i]) && good;
  }
  Json index = {{"format", "tractus-measurements/1"}, {"rig", "palpation"}, {"trials", trials}};
  if (plan.request.states_tract) {
    const Vec3 &entry = plan.tract.entry_m, axis = plan.tract.along.normalized();
    index["tract"] = {{"entry_m", {entry[0], entry[1], entry[2]}},
                      {"axis", {axis[0], axis[1], axis[2]}},
                      {"length_m", plan.tract.depth_m}};
  }
  return put(folder / "measurements" / "set.json", index) && good;
}

bool write_truth(const PalpationSet& set, const fs::path& file) {
  const PalpationPlan& plan = set.plan;
  return put(file, {{"format", "blind-truth/1"},
                    {"rig", "palpation"},
                    {"seed", plan.request.seed},
                    {"accepted", set.accepted},
                    {"kind", plan.kind},
                    {"effects", effects_json(set)},
                    {"projected_rms", set.hidden_projected_N},
                    {"force_rms", set.force_rms_N},
                    {"peak", set.peak_N},
                    {"floor", std::hypot(set.sensor_floor_N, set.pose_floor_N)},
                    {"sensor_floor", set.sensor_floor_N},
                    {"pose_floor", set.pose_floor_N},
                    {"jumps", set.jump_share},
                    {"supplied", plan.how},
                    {"fixed", plan.fixed},
                    {"volume", plan.source},
                    {"field", plan.field == FieldKind::kPaper ? "paper" : "potential"},
                    {"base", base_json(plan.truth, plan.field)}});
}

}  // namespace blind
