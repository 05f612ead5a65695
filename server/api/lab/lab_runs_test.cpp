#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "core/try.hpp"
#include "db/store/lab/lab.hpp"
#include "db/store/operations/jobs.hpp"
#include "server/api/api_test_support.hpp"
#include "server/jobs/lab_run.hpp"

namespace tractus {
namespace api::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* kModel = R"({"format":"tractus-model/1","rig":"probing","name":"one layer",
"base":{"layers":[{"start_m":0,"thickness_m":0.05,"stiffness_N_per_m":4000,"damping_Ns_per_m":2000,
"equilibrium_m":0}],"rotary":{"viscous_Nms_per_rad":0.02,"detent_Nm":0.01,"detent_pitch_rad":0.35}}})";

class LabRoutes : public ApiTest {
 protected:
  http::Response post(const std::string& target, const std::string& body,
                      const std::string& type = "application/json") {
    return ask(request("POST", "/api/v1/lab/" + target,
                       {{"cookie", cookie_}, {"x-tractus", "1"}, {"content-type", type}}, body));
  }
  http::Response get(const std::string& target) {
    return ask(request("GET", "/api/v1/lab/" + target, {{"cookie", cookie_}}));
  }

  /// A spring and a damper with 2.5 N of dry friction, as a zip made by Python.
  std::string zip() {
    const auto folder = folder_.path() / "set";
    std::filesystem::create_directories(folder);
    std::string trials;
    for (int trial = 0; trial < 4; ++trial) {
      const std::string file = "t" + std::to_string(trial) + ".csv";
      std::ofstream csv(folder / file);
      csv.precision(12);
      csv << "t_s,x_m,fz_N\n";
      for (int k = 0; k < 2500; ++k) {
        const double t = 0.002 * k, w = 1.1 + 0.2 * trial;
        const double x = 0.01 + 0.006 * std::sin(w * t) + 0.002 * std::sin(3.3 * t + trial);
        const double v = 0.006 * w * std::cos(w * t) + 0.0066 * std::cos(3.3 * t + trial);
        const double noise = 0.05 * std::sin(7919.0 * k * (k + 1.0 + trial));
        csv << t << ',' << x << ',' << 4000.0 * x + 2000.0 * v + (v > 0.0 ? 2.5 : -2.5) + noise
            << '\n';
      }
      trials += std::string(trial ? "," : "") + R"({"id":")" + file.substr(0, 2) + R"(","file":")" +
                file + R"("})";
    }
    std::ofstream(folder / "set.json")
        << R"({"format":"tractus-measurements/1","rig":"probing","trials":[)" << trials << "]}";
    const auto path = folder_.path() / "set.zip";
    EXPECT_EQ(std::system(("cd " + folder_.path().string() + " && python3 -m zipfile -c " +
                           path.string() + " set")
                              .c_str()),
              0);
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string model() { return json(post("models", kModel))["id"]; }
  std::string set() {
    return json(post("measurements?name=bench", zip(), "application/zip"))["id"];
  }
  /// A queued run of the lab; its id.
  std::string queued(const std::string& kind, core::Json more = core::Json::object()) {
    core::Json body{{"model", model()}, {"measurements", set()}};
    body.update(more);
    const auto run = post(kind, body.dump());
    EXPECT_EQ(run.status, 201) << text(run);
    return json(run)["id"].get<std::string>();
  }
  core::Json done(const std::string& id) {
    const auto worked = jobs::run_lab(store_, objects_, id, [] { return false; });
    EXPECT_TRUE(worked) << worked.error().what;
    return json(get("runs/" + id));
  }
  std::string cookie_ = cookie();
};

constexpr const char* kSquare = R"json({"format":"tractus-effect/1","id":"expression:square",
"rig":"probing","adds_to":"fz_N","formula":"c * v_m_s * abs(v_m_s)",
"parameters":{"c":{"unit":"N*s^2/m^2","initial":1,"low":0,"high":10000}}})json";

TEST_F(LabRoutes, ADiagnosisMakesAResultAReportAndAModel) {
  const std::string id = queued("diagnoses");
  EXPECT_EQ(woken_, 1);
  EXPECT_EQ(json(get("runs/" + id))["state"], "queued");
  const auto run = done(id);
  EXPECT_EQ(run["state"], "done");
  EXPECT_EQ(run["made_by"], "ada");
  EXPECT_EQ(run["diagnosis"]["effects"][0]["id"], "coulomb_friction");
  EXPECT_EQ(run["ranking"][0]["id"], "coulomb_friction");
  EXPECT_LT(run["comparisons"]["after"]["channels"][0]["rmse"],
            run["comparisons"]["before"]["channels"][0]["rmse"]);
  const auto report = get("runs/" + id + "/report");
  EXPECT_EQ(report.status, 200);
  EXPECT_THAT(std::string(report.header("Content-Security-Policy")), HasSubstr("sandbox"));
  EXPECT_EQ(get("runs/" + id + "/model").status, 200);
  const auto all = json(get("runs?kind=diagnosis&model=" + run["model"].get<std::string>()));
  ASSERT_EQ(all["runs"].size(), 1u);
  EXPECT_TRUE(all["runs"][0]["diagnosis"].is_null()) << "a list is light";
}

TEST_F(LabRoutes, NothingIsPublishedUntilSomeoneSaysSo) {
  const std::string id = queued("diagnoses");
  EXPECT_EQ(post("runs/" + id + "/publish", "{}").status, 409);
  EXPECT_TRUE(done(id)["version"].is_null());
  EXPECT_EQ(json(get("models"))["models"].size(), 1u);
  const auto first =
      post("runs/" + id + "/publish", R"({"name":"with friction","note":"bench of May"})");
  ASSERT_EQ(first.status, 201) << text(first);
  EXPECT_EQ(json(first)["name"], "with friction");
  EXPECT_EQ(json(first)["note"], "bench of May");
  EXPECT_EQ(json(first)["parent"], json(get("runs/" + id))["model"]);
  EXPECT_EQ(json(first)["run"], id);
  const auto again = post("runs/" + id + "/publish", "");
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(json(again)["id"], json(first)["id"]);
  EXPECT_EQ(json(get("runs/" + id))["version"], json(first)["id"]);
  EXPECT_EQ(json(get("models"))["models"].size(), 2u);
}

TEST_F(LabRoutes, TheUsersOwnEffectIsRankedWithTheCatalogues) {
  const auto run =
      done(queued("diagnoses", {{"own", core::Json::array({core::Json::parse(kSquare)})}}));
  EXPECT_EQ(run["own"], core::Json{"expression:square"});
  std::size_t seen = 0;
  for (const auto& ranked : run["diagnosis"]["ranking"])
    seen += ranked["id"] == "expression:square";
  EXPECT_EQ(seen, 1u);
  EXPECT_EQ(run["diagnosis"]["effects"][0]["id"], "coulomb_friction");
}

TEST_F(LabRoutes, AFitTakesEffectsByHand) {
  const auto run = done(queued("fits", {{"add", {"coulomb_friction"}}}));
  ASSERT_EQ(run["state"], "done");
  const double friction_N =
      run["fit"]["effects"][0]["parameters"]["friction_N"]["value"].get<double>();
  EXPECT_NEAR(friction_N, 2.5, 0.05);  // as the set was made
}

TEST_F(LabRoutes, AComparisonHoldsTwoVersionsBesideASet) {
  const std::string fit = queued("fits", {{"add", {"coulomb_friction"}}});
  done(fit);
  const std::string better = json(post("runs/" + fit + "/publish", "{}"))["id"];
  const auto run = done(queued("comparisons", {{"against", better}}));
  EXPECT_TRUE(run["diagnosis"].is_null());
  EXPECT_FALSE(run["model_ready"]);
  EXPECT_LT(run["comparisons"]["after"]["channels"][0]["rmse"],
            run["comparisons"]["before"]["channels"][0]["rmse"]);
}

TEST_F(LabRoutes, SignalsOfATrialComeAtTheZoomAskedFor) {
  const std::string id = queued("comparisons");
  const std::string tail = "runs/" + id + "/signals?trial=t1&channel=fz_N";
  EXPECT_EQ(get(tail).status, 404) << "nothing is there before it is done";
  done(id);
  const auto whole = json(get(tail + "&points=100"));
  // 2500 samples, 2 ms apart.
  EXPECT_NEAR(whole["duration_s"].get<double>(), 4.998, 1e-6);
  EXPECT_EQ(whole["samples_per_point"], 25);
  EXPECT_EQ(whole["measured"]["max"].size(), 100u);
  EXPECT_EQ(whole["regions"].size(),
            json(get("runs/" + id))["comparisons"]["before"]["where"].size());
  const auto part = json(get(tail + "&from_s=1&to_s=1.1"));
  EXPECT_EQ(part["samples_per_point"], 1);
  EXPECT_NEAR(part["t_s"][0].get<double>(), 1.0, 1e-6);
  EXPECT_EQ(get(tail + "&side=after").status, 404);
  EXPECT_EQ(get(tail + "&side=middle").status, 400);
  EXPECT_EQ(get("runs/" + id + "/signals?trial=t9&channel=fz_N").status, 404);
}

TEST_F(LabRoutes, OneThatIsStoppedDoesNothing) {
  const std::string id = queued("diagnoses");
  EXPECT_EQ(json(post("runs/" + id + "/stop", ""))["state"], "cancelled");
  EXPECT_EQ(done(id)["state"], "cancelled");
  EXPECT_EQ(get("runs/" + id + "/report").status, 404);
}

TEST_F(LabRoutes, OneThatRunsIsStoppedWhenItNextLooks) {
  const std::string id = queued("diagnoses");
  int looks = 0;
  const auto stopped = jobs::run_lab(store_, objects_, id, [&] {
    if (++looks == 2) post("runs/" + id + "/stop", "");
    return looks > 1000;
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Errc::cancelled);
  EXPECT_LT(looks, 1000);
}

TEST_F(LabRoutes, AServerThatEndsLeavesItToTheNextStart) {
  const std::string id = queued("diagnoses");
  const auto done = jobs::run_lab(store_, objects_, id, [] { return true; });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, core::Errc::cancelled);
  EXPECT_EQ(json(get("runs/" + id))["state"], "queued");
}

TEST_F(LabRoutes, TheSameMeasurementsAreTheSameSet) {
  const std::string bytes = zip();
  const auto first = json(post("measurements?name=a", bytes, "application/zip"));
  EXPECT_EQ(first["rig"], "probing");
  EXPECT_EQ(first["trials"], 4);
  EXPECT_EQ(first["samples"], 10000);
  EXPECT_EQ(first["id"], json(post("measurements?name=b", bytes, "application/zip"))["id"]);
  EXPECT_EQ(json(get("measurements"))["measurements"], core::Json::array({first}));
}

TEST_F(LabRoutes, AnEffectOfOnesOwnIsCheckedAsItIsWritten) {
  EXPECT_TRUE(json(post("effects/check", kSquare))["ok"]);
  std::string wrong = kSquare;
  wrong.replace(wrong.find("c * v_m_s * abs"), 3, "c + ");
  const auto answer = json(post("effects/check", wrong));
  EXPECT_FALSE(answer["ok"]);
  EXPECT_THAT(answer["error"].get<std::string>(), HasSubstr("N*s^2/m^2"));
  EXPECT_EQ(json(get("effects?rig=probing"))["adds_to"], "fz_N");
}

TEST_F(LabRoutes, TheCatalogueSaysWhichChannelShowsAnEffect) {
  // An effect on the torque is one whose numbers are torques, by their units.
  for (const core::Json& effect : json(get("effects?rig=probing"))["effects"]) {
    bool of_torque = false;
    for (const core::Json& parameter : effect["parameters"])
      of_torque |= parameter["unit"].get<std::string>().starts_with("N·m");
    EXPECT_EQ(effect["channel"], of_torque ? "tz_Nm" : "fz_N") << effect["id"];
  }
  for (const core::Json& effect : json(get("effects?rig=palpation"))["effects"])
    EXPECT_TRUE(effect["channel"].is_null()) << effect["id"];
}

TEST_F(LabRoutes, RefusesWhatIsWrong) {
  EXPECT_EQ(post("models", R"({"format":"tractus-model/1","rig":"loom"})").status, 400);
  EXPECT_EQ(post("models?parent=nobody", kModel).status, 404);
  EXPECT_EQ(post("measurements?name=a", "text", "application/zip").status, 400);
  const auto broken = post("measurements?name=a", "PK nothing that follows", "application/zip");
  EXPECT_EQ(broken.status, 400);
  EXPECT_THAT(text(broken), ::testing::Not(HasSubstr("/tmp")));
  EXPECT_EQ(post("diagnoses", R"({"model":"x","measurements":"y"})").status, 404);
  EXPECT_EQ(
      post("comparisons",
           core::Json{{"model", model()}, {"measurements", set()}, {"own", core::Json::array()}}
               .dump())
          .status,
      400);
  EXPECT_EQ(get("runs/none").status, 404);
  EXPECT_EQ(ask(request("GET", "/api/v1/lab/models", station("token-1"))).status, 403);
  EXPECT_EQ(ask(request("GET", "/api/v1/lab/models")).status, 401);
}

/// The runner's thread for scores claims by kind: what waits for the lab before it is no hindrance.
TEST_F(LabRoutes, AScoreIsClaimedBeforeALabRunThatWaitsLonger) {
  auto queued_both = store_.write([](store::Writing& tx) -> core::Result<void> {
    TRY(store::queue_job(tx, store::JobKind::lab, "first", 1));
    return store::queue_job(tx, store::JobKind::metrics, "second", 2);
  });
  ASSERT_TRUE(queued_both);
  const auto claimed = store_.write(
      [](store::Writing& tx) { return store::claim_job(tx, {store::JobKind::metrics}, 3); });
  ASSERT_TRUE(claimed);
  ASSERT_TRUE(*claimed);
  EXPECT_EQ((*claimed)->subject, "second");
}

}  // namespace
}  // namespace api::testing
}  // namespace tractus
