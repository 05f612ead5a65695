/// The commands' JSON against shared/doc/lab-answers.md: no field more, none less.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <checkout.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "core/bytes.hpp"
#include "core/json.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using Paths = std::set<std::string>;

const std::string kTractus = std::string(checkout::kBin) + "/tractus";

/// Field → what stands in its last column, by format.
using Documented = std::map<std::string, std::map<std::string, std::string>>;

Documented documented() {
  Documented out;
  std::ifstream file(std::string(checkout::kSource) + "/shared/doc/lab-answers.md");
  std::string line, format;
  while (std::getline(file, line)) {
    if (line.starts_with("## `")) format = line.substr(4, line.find('`', 4) - 4);
    if (!line.starts_with("| `")) continue;
    const auto end = line.find('`', 3);
    out[format][line.substr(3, end - 3)] = line.substr(end + 1);
  }
  return out;
}

/// Every field of an answer; of an array of numbers or texts the field with "[]".
void add_paths(const core::Json& json, const std::string& at, Paths& out) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      add_paths(value, at.empty() ? key : at + "." + key, out);
    return;
  }
  if (json.is_array()) {
    if (json.empty()) out.insert(at + "[]");
    for (const auto& value : json) add_paths(value, at + "[]", out);
    return;
  }
  out.insert(at);
}

/// Does a documented field, with `*` for any name (at its end: for anything below), say this one?
bool says(std::string_view field, std::string_view path) {
  while (!field.empty() && !path.empty()) {
    const auto a = field.substr(0, field.find('.')), b = path.substr(0, path.find('.'));
    if (a == "*" && a.size() == field.size()) return true;
    if (a != b && a != "*") return false;
    field.remove_prefix(std::min(field.size(), a.size() + 1));
    path.remove_prefix(std::min(path.size(), b.size() + 1));
  }
  return field.empty() && path.empty();
}

/// An array or object that holds nothing here, or null: its fields cannot be seen.
bool hidden_by(const std::string& path, const std::string& field) {
  const std::string whole = path.ends_with("[]") ? path.substr(0, path.size() - 2) : path;
  return field.starts_with(whole) && field.size() > whole.size() &&
         (field[whole.size()] == '.' || field[whole.size()] == '[');
}

class LabAnswers : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = fs::temp_directory_path() / ("tractus_answers_" + core::new_id());
    fs::create_directories(folder_ / "set");
    std::string trials;
    for (int trial = 0; trial < 4; ++trial) {
      std::ofstream csv(folder_ / fmt::format("set/t{}.csv", trial));
      csv << "t_s,x_m,theta_rad,fz_N,tz_Nm\n";
      for (int k = 0; k < 1000; ++k) {
        const double t = 0.004 * k, w = 1.1 + 0.2 * trial;
        const double x = 0.010 + 0.006 * std::sin(w * t) + 0.002 * std::sin(3.3 * t + trial);
        const double v = 0.006 * w * std::cos(w * t) + 0.0066 * std::cos(3.3 * t + trial);
        const double noise = 0.05 * std::sin(7919.0 * k * (k + 1.0 + trial));
        csv << fmt::format("{},{},{},{},{}\n", t, x, 2.0 * t,
                           4000.0 * x + 2000.0 * v + (v > 0.0 ? 2.5 : -2.5) + noise, 0.04);
      }
      trials += fmt::format(R"({}{{"id":"t{}","file":"t{}.csv","operator":"S1"}})",
                            trial ? "," : "", trial, trial);
    }
    std::ofstream(folder_ / "set/set.json")
        << R"({"format":"tractus-measurements/1","rig":"probing","simulated":true,"trials":[)"
        << trials << "]}";
    std::ofstream(folder_ / "model.json")
        << R"({"format":"tractus-model/1","rig":"probing","name":"one layer","base":{"layers":[)"
        << R"({"start_m":0,"thickness_m":0.05,"stiffness_N_per_m":4000,"damping_Ns_per_m":2000,)"
        << R"("equilibrium_m":0}],"rotary":{"viscous_Nms_per_rad":0.02,"detent_Nm":0.01,)"
        << R"("detent_pitch_rad":0.35}},"effects":[]})";
    // The same law as coulomb_friction, so that there is something to settle.
    std::ofstream(folder_ / "own.json")
        << R"json({"format":"tractus-effect/1","id":"expression:rub","rig":"probing",)json"
        << R"json("adds_to":"fz_N","formula":"c * sgn(v_m_s)",)json"
        << R"json("parameters":{"c":{"unit":"N","initial":1,"low":0,"high":100}}})json";
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static core::Json answer(const std::string& command, const std::string& more) {
    const std::string line = fmt::format("{} {} --model {} --measurements {} {} --json", kTractus,
                                         command, at("model.json"), at("set"), more);
    FILE* pipe = ::popen(line.c_str(), "r");
    std::string out;
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
    EXPECT_EQ(WEXITSTATUS(::pclose(pipe)), 0) << line;
    auto json = core::parse_json(out, command);
    EXPECT_TRUE(json) << out.substr(0, 300);
    return json ? *json : core::Json::object();
  }
  static std::string at(const std::string& name) { return (folder_ / name).string(); }

  static void expect_documented(const core::Json& json, const std::string& section) {
    const auto fields = documented()[section];
    ASSERT_FALSE(fields.empty()) << section << " is not in the document";
    Paths paths;
    add_paths(json, "", paths);
    for (const std::string& path : paths)
      EXPECT_TRUE(std::ranges::any_of(fields,
                                      [&](const auto& field) {
                                        return says(field.first, path) ||
                                               hidden_by(path, field.first);
                                      }))
          << section << ": " << path << " is not documented";
    for (const auto& [field, words] : fields) {
      if (words.find("optional") != std::string::npos) continue;
      EXPECT_TRUE(std::ranges::any_of(paths,
                                      [&](const auto& path) {
                                        return says(field, path) || hidden_by(path, field) ||
                                               hidden_by(field, path);
                                      }))
          << section << ": the answer has no " << field;
    }
  }
  /// The same rig with 0.3 of the bone's force as dry friction on top, which no effect of the
  /// catalogue is: |4000 x + 2000 v|, and the probe passes the depth at which the spring is at rest.
  static void write_rubbing_set() {
    fs::create_directories(folder_ / "rub");
    std::string trials;
    for (int trial = 0; trial < 6; ++trial) {
      std::ofstream csv(folder_ / fmt::format("rub/t{}.csv", trial));
      csv << "t_s,x_m,fz_N\n";
      for (int k = 0; k < 3000; ++k) {
        const double t = 0.002 * k, w = 1.1 + 0.3 * trial;
        const double x = 0.010 + 0.007 * std::sin(w * t) + 0.002 * std::sin(5.3 * t + trial);
        const double v = 0.007 * w * std::cos(w * t) + 0.0106 * std::cos(5.3 * t + trial);
        const double bone = 4000.0 * (x - 0.006) + 2000.0 * v;
        const double noise = 0.05 * std::sin(7919.0 * k * (k + 1.0 + trial));
        csv << fmt::format("{},{},{}\n", t, x,
                           bone + 0.3 * std::abs(bone) * (v > 0 ? 1 : -1) + noise);
      }
      trials += fmt::format(R"({}{{"id":"t{}","file":"t{}.csv"}})", trial ? "," : "", trial, trial);
    }
    std::ofstream(folder_ / "rub/set.json")
        << R"({"format":"tractus-measurements/1","rig":"probing","simulated":true,"trials":[)"
        << trials << "]}";
    std::ofstream(folder_ / "rub.json")
        << R"({"format":"tractus-model/1","rig":"probing","name":"one layer","base":{"layers":[)"
        << R"({"start_m":0,"thickness_m":0.05,"stiffness_N_per_m":3800,"damping_Ns_per_m":2100,)"
        << R"("equilibrium_m":0.006}]},"effects":[]})";
  }
  static int run(const std::string& arguments, std::string& out) {
    FILE* pipe = ::popen((kTractus + " " + arguments + " 2>&1").c_str(), "r");
    char buffer[4096];
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
    return WEXITSTATUS(::pclose(pipe));
  }
  static fs::path folder_;
};
fs::path LabAnswers::folder_;

TEST_F(LabAnswers, AComparisonHasTheFieldsThatAreWrittenDown) {
  expect_documented(answer("compare", ""), "tractus-comparison/1");
}

TEST_F(LabAnswers, ADiagnosisHasTheFieldsThatAreWrittenDown) {
  const auto json = answer("diagnose", "--effect " + at("own.json"));
  ASSERT_FALSE(json["settle"].is_null()) << "two names of one law leave something to settle";
  ASSERT_FALSE(json["confounded"].empty());
  ASSERT_FALSE(json["effects"].empty());
  expect_documented(json, "tractus-diagnosis/1");
}

TEST_F(LabAnswers, AFormulaIsProposedForWhatNoCatalogueHasAndCanBeAdded) {
  write_rubbing_set();
  const std::string sources = "--model " + at("rub.json") + " --measurements " + at("rub");
  fs::create_directories(folder_ / "found");
  std::string text;
  ASSERT_EQ(
      run("diagnose --json --propose 3 --write-proposals " + at("found") + " " + sources, text), 0)
      << text;
  const auto json = core::parse_json(text, "diagnose");
  ASSERT_TRUE(json) << text.substr(0, 300);
  expect_documented(*json, "tractus-diagnosis/1");
  const auto& proposals = (*json)["discovery"]["proposals"];
  ASSERT_FALSE(proposals.empty()) << text;
  const auto& best = proposals[0];
  EXPECT_EQ(best["formula"], "amplitude * abs(base_N) * sgn(v_m_s)");
  EXPECT_NEAR(best["terms"][0]["numbers"]["amplitude"]["value"].get<double>(), 0.3, 0.006);
  EXPECT_EQ(best["trials_improved"], 6);
  EXPECT_TRUE(best["passive"]);

  text.clear();
  ASSERT_EQ(run("diagnose --propose 3 " + sources, text), 0) << text;
  EXPECT_NE(text.find("1. amplitude * abs(base_N) * sgn(v_m_s)"), std::string::npos) << text;
  EXPECT_NE(text.find("dry friction (Coulomb) in proportion to the load"), std::string::npos);

  text.clear();
  ASSERT_EQ(run("fit --json --out " + at("fitted.json") + " --effect " +
                    at("found/proposal_1.json") + " " + sources,
                text),
            0)
      << text;
  const auto fit = core::parse_json(text, "fit");
  ASSERT_TRUE(fit) << text.substr(0, 300);
  EXPECT_LT((*fit)["held_out_rmse"].get<double>(),
            0.3 * (*json)["base"]["held_out_rmse"].get<double>());
}

TEST_F(LabAnswers, AFolderForProposalsThatIsNoneIsRefused) {
  std::string text;
  EXPECT_EQ(run("diagnose --write-proposals " + at("nowhere") + " --model " + at("model.json") +
                    " --measurements " + at("set"),
                text),
            2);
  EXPECT_NE(text.find("there is no such folder"), std::string::npos) << text;
}

TEST_F(LabAnswers, AFitHasTheFieldsThatAreWrittenDown) {
  expect_documented(
      answer("fit", "--add coulomb_friction --add quadratic_drag --out " + at("f.json")),
      "tractus-fit/1");
}

TEST_F(LabAnswers, AReplayHasTheFieldsThatAreWrittenDown) {
  expect_documented(answer("replay", "--out " + at("replayed")), "tractus-replay/1");
}

}  // namespace
}  // namespace tractus
