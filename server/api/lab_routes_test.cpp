#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "db/store/lab.hpp"
#include "server/api/api_test_support.hpp"
#include "server/jobs/diagnose.hpp"

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
  /// A queued diagnosis; its id.
  std::string queued(const std::string& zip_bytes) {
    const auto model = json(post("models", kModel));
    const auto set = json(post("measurements?name=bench", zip_bytes, "application/zip"));
    const auto run =
        post("diagnoses", core::Json{{"model", model["id"]}, {"measurements", set["id"]}}.dump());
    EXPECT_EQ(run.status, 201) << text(run);
    return json(run)["id"].get<std::string>();
  }
  std::string cookie_ = cookie();
};

TEST_F(LabRoutes, ADiagnosisMakesAResultAReportAndAVersionOfTheModel) {
  const std::string id = queued(zip());
  EXPECT_EQ(woken_, 1);
  EXPECT_EQ(json(get("diagnoses/" + id))["state"], "queued");
  const auto done = jobs::diagnose(store_, objects_, id, [] { return false; });
  ASSERT_TRUE(done) << done.error().what;
  const auto run = json(get("diagnoses/" + id));
  EXPECT_EQ(run["state"], "done");
  EXPECT_EQ(run["made_by"], "ada");
  EXPECT_EQ(run["result"]["effects"][0]["id"], "coulomb_friction");
  const auto report = get("diagnoses/" + id + "/report");
  EXPECT_EQ(report.status, 200);
  EXPECT_THAT(std::string(report.header("Content-Security-Policy")), HasSubstr("sandbox"));
  const auto models = json(get("models"))["models"];
  ASSERT_EQ(models.size(), 2u);
  for (const auto& model : models) {
    if (model["id"] != run["better_model"]) continue;
    EXPECT_EQ(model["parent"], run["model"]);
    EXPECT_EQ(model["diagnosis"], id);
    return;
  }
  FAIL() << "the better model is not in the list";
}

TEST_F(LabRoutes, OneThatIsStoppedDoesNothing) {
  const std::string id = queued(zip());
  EXPECT_EQ(json(post("diagnoses/" + id + "/stop", ""))["state"], "cancelled");
  ASSERT_TRUE(jobs::diagnose(store_, objects_, id, [] { return false; }));
  EXPECT_EQ(json(get("diagnoses/" + id))["state"], "cancelled");
  EXPECT_EQ(get("diagnoses/" + id + "/report").status, 404);
}

TEST_F(LabRoutes, AServerThatEndsLeavesItToTheNextStart) {
  const std::string id = queued(zip());
  const auto done = jobs::diagnose(store_, objects_, id, [] { return true; });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, core::Errc::cancelled);
  EXPECT_EQ(json(get("diagnoses/" + id))["state"], "queued");
}

TEST_F(LabRoutes, TheSameMeasurementsAreTheSameSet) {
  const std::string bytes = zip();
  const auto first = json(post("measurements?name=a", bytes, "application/zip"));
  EXPECT_EQ(first["id"], json(post("measurements?name=b", bytes, "application/zip"))["id"]);
}

TEST_F(LabRoutes, RefusesWhatIsWrong) {
  EXPECT_EQ(post("models", R"({"format":"tractus-model/1","rig":"loom"})").status, 400);
  EXPECT_EQ(post("measurements?name=a", "text", "application/zip").status, 400);
  EXPECT_EQ(post("diagnoses", R"({"model":"x","measurements":"y"})").status, 404);
  EXPECT_EQ(get("diagnoses/none").status, 404);
  EXPECT_EQ(ask(request("GET", "/api/v1/lab/models", station("token-1"))).status, 403);
  EXPECT_EQ(ask(request("GET", "/api/v1/lab/models")).status, 401);
}

TEST_F(LabRoutes, AZipThatIsNoSetIsSaidInTheJobsError) {
  const std::string id = queued("PK nothing that follows");
  const auto done = jobs::diagnose(store_, objects_, id, [] { return false; });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, core::Errc::bad_input);
}

}  // namespace
}  // namespace api::testing
