/// `tractus analyse` and `tractus trainee` from the outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <checkout.hpp>
#include <cstdlib>
#include <filesystem>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kSource = checkout::kSource;
const std::string kExample = kSource + "/shared/assessment/examples/probing-study/";
const std::string kTrials =
    kSource + "/tests/golden/statistics-reference/data/sim_cohort_trials.csv";

class Analyse : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("tractus_analyse_" + core::new_id());
    fs::create_directories(folder_);
    fs::copy(kExample, folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string text_of(const std::string& name) {
    const auto bytes = core::read_file(folder_ / name);
    return bytes ? std::string(core::text_of(*bytes)) : "";
  }
  /// Exit code of the tool, run in the folder; its output in out_ and err_.
  int run(const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && '" + checkout::kBin +
                                "/tractus' " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    out_ = text_of("out.txt");
    err_ = text_of("err.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  fs::path folder_;
  std::string out_, err_;
};

TEST_F(Analyse, LocksFreezesRunsTwiceAndReports) {
  EXPECT_EQ(run("analyse freeze surgeons.csv cohort --source \"Tables 2 and 4\""), 0) << err_;
  EXPECT_EQ(run("analyse run plan.json cohort"), 2);
  EXPECT_THAT(err_, HasSubstr("the plan is not locked"));
  EXPECT_EQ(run("analyse lock plan.json --who A --data-seen"), 0) << err_;
  EXPECT_EQ(run("analyse run plan.json cohort --out once.json"), 0) << err_;
  EXPECT_THAT(out_, HasSubstr("published, section 6.2: 0.818; computed 0.8083"));
  EXPECT_EQ(run("analyse run plan.json cohort --against once.json"), 0);
  EXPECT_THAT(err_, HasSubstr("the same to the last digit"));
  EXPECT_EQ(run("analyse report plan.json cohort report"), 0) << err_;
  EXPECT_THAT(text_of("report/report.html"), HasSubstr("confirms nothing"));
  EXPECT_THAT(text_of("report/data.csv"), HasSubstr("excluded_because"));
  EXPECT_EQ(text_of("report/result.json"), text_of("once.json"));
  EXPECT_EQ(run("analyse report plan.json cohort report"), 2);
  EXPECT_THAT(err_, HasSubstr("exists already"));
}

TEST_F(Analyse, RefusesAPlanOrDataThatWereChanged) {
  EXPECT_EQ(run("analyse freeze surgeons.csv cohort"), 0);
  EXPECT_EQ(run("analyse lock plan.json --who A"), 0);
  EXPECT_EQ(run("analyse lock plan.json --who B"), 2);
  EXPECT_EQ(
      std::system(("cd '" + folder_.string() +
                   "' && sed 's/\"alpha\": 0.05/\"alpha\": 0.06/' plan.json > changed.json && "
                   "sed -i 's/^1,6,2,/1,6,3,/' cohort/data.csv")
                      .c_str()),
      0);
  EXPECT_EQ(run("analyse run changed.json cohort"), 2);
  EXPECT_THAT(err_, HasSubstr("the plan was changed after A locked it"));
  EXPECT_EQ(run("analyse run plan.json cohort"), 2);
  EXPECT_THAT(err_, HasSubstr("the data were changed after they were frozen"));
  EXPECT_EQ(std::ranges::count(err_, '\n'), 1);
}

TEST_F(Analyse, ATraineesPageSaysThatTwelveTrialsAreTooFew) {
  const std::string data = "trainee --data '" + kTrials + "' --id surgeon --order trial_order ";
  EXPECT_EQ(run(data + "--who S01 --html S01.html --simulated"), 0) << err_;
  EXPECT_THAT(out_, HasSubstr("12 trials are too few to certify anybody"));
  EXPECT_THAT(text_of("S01.html"), HasSubstr("simulated"));
  EXPECT_EQ(run(data + "--json"), 0);
  const auto all = core::parse_json(out_, "stdout");
  ASSERT_TRUE(all);
  EXPECT_EQ(all->size(), 10u);
  EXPECT_EQ(run(data + "--who S99"), 2);
  EXPECT_THAT(err_, HasSubstr("there is no 'S99' in column 'surgeon'"));
  EXPECT_EQ(run(data + "--adequate 0.5"), 2);
  EXPECT_EQ(run("trainee --data '" + kTrials + "'"), 2);
  EXPECT_THAT(err_, HasSubstr("there is no column 'participant'"));
}

}  // namespace
}  // namespace tractus
