#include "station/session/study_plan.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "station/uplink/study.hpp"

namespace tractus {
namespace session {
namespace {
namespace fs = std::filesystem;

class StudyPlans : public testing::Test {
 protected:
  StudyPlans() {
    std::string name = fs::temp_directory_path() / "station-XXXXXX";
    root_ = ::mkdtemp(name.data());
  }
  ~StudyPlans() override { fs::remove_all(root_); }
  StationFolder folder() { return std::move(StationFolder::open(root_).value()); }
  static wire::StudyWork work() {
    return {
        .study = "spine",
        .participant = "P1",
        .simulated = true,
        .experience_years = 0.5,
        .unfinished = 2,
        .planned = 12,
        .trials = {{std::string(64, 'a'), 11, "sealed-a"}, {std::string(64, 'b'), 12, "sealed-b"}}};
  }
  fs::path root_;
};

TEST_F(StudyPlans, AreReadBackAsTheyWereTaken) {
  const auto where = folder();
  ASSERT_TRUE(keep_work(where, work()));
  const auto back = kept_work(where, "spine", "P1");
  ASSERT_TRUE(back) << back.error().what;
  EXPECT_EQ(back->to_json(), work().to_json());
  EXPECT_EQ(kept_work(where, "spine", "P2").error().code, core::Errc::not_found);
}

TEST_F(StudyPlans, SpendATrialThatWasBegunAndNoOther) {
  const auto where = folder();
  EXPECT_EQ(still_to_do(where, work())->size(), 2u);
  const std::string trial(32, '1');
  std::ofstream(where.trial_file(trial)) << "what a crash left";
  ASSERT_TRUE(where.outbox().queue(trial, std::string(64, 'a'), where.trial_file(trial)));
  const auto left = still_to_do(where, work());
  ASSERT_EQ(left->size(), 1u);
  EXPECT_EQ(left->front().slot, std::string(64, 'b'));
}

TEST_F(StudyPlans, ThatAreRubbishAreRefusedByTheirFilesName) {
  const auto where = folder();
  fs::create_directories(where.studies() / "spine");
  std::ofstream(where.studies() / "spine" / "P1.json") << R"({"study":"spine","trials":7})";
  const auto refused = kept_work(where, "spine", "P1");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::bad_input);
  EXPECT_NE(refused.error().what.find("P1.json"), std::string::npos);
}

/// Answers every question alike, and keeps what was asked.
class OneAnswer final : public uplink::Server {
 public:
  OneAnswer(int status, const core::Json& json) : status_(status), text_(json.dump()) {}
  core::Result<uplink::HttpResponse> send(const uplink::Request& request) override {
    asked = request.method + " " + request.path;
    const auto bytes = core::bytes_of(text_);
    return uplink::HttpResponse{status_, core::Bytes(bytes.begin(), bytes.end())};
  }
  std::string asked;

 private:
  int status_;
  std::string text_;
};

TEST_F(StudyPlans, AreAskedForByStudyAndParticipant) {
  OneAnswer server(200, work().to_json());
  const auto taken = uplink::take_trials(server, "spine", "P1", 400);
  ASSERT_TRUE(taken) << taken.error().what;
  EXPECT_EQ(server.asked, "POST /api/v1/studies/spine/participants/P1/take?ahead=400");
  EXPECT_EQ(taken->trials.size(), 2u);
}

TEST_F(StudyPlans, OfSomebodyElseOrOfNoShapeAreRefused) {
  OneAnswer other(200, work().to_json());
  EXPECT_FALSE(uplink::take_trials(other, "spine", "P2", 1));
  auto odd = work().to_json();
  odd["trials"][0]["slot"] = "../../etc/passwd";
  OneAnswer rubbish(200, odd);
  EXPECT_EQ(uplink::take_trials(rubbish, "spine", "P1", 1).error().code, core::Errc::bad_input);
  OneAnswer none(200, 7);
  EXPECT_FALSE(uplink::take_trials(none, "spine", "P1", 1));
}

TEST_F(StudyPlans, OfANameThatIsNoneAreNotEvenAskedFor) {
  OneAnswer server(200, work().to_json());
  for (const char* name : {"", "../x", "a b", "a/b", "a?b"})
    EXPECT_FALSE(uplink::take_trials(server, "spine", name, 1)) << name;
  EXPECT_EQ(server.asked, "");
}

TEST_F(StudyPlans, KeepTheServersWordsWhenItSaysNo) {
  OneAnswer paused(409, {{"error", "study spine is paused"}, {"code", "conflict"}});
  const auto refused = uplink::take_trials(paused, "spine", "P1", 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  EXPECT_NE(refused.error().what.find("paused"), std::string::npos);
}

}  // namespace
}  // namespace session
}  // namespace tractus
