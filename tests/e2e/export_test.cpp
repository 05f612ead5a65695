/// A cohort from the real server, downloaded by curl: whole, resumed, and ended by a withdrawal.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <thread>

#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

constexpr std::uint32_t kSamples = 200'000;
constexpr std::uint64_t kArray_bytes = 128 + kSamples * 15ull * 8;  // .npy: head, 15 doubles a row
constexpr int kTrials = 3;

struct Ran {
  int code;
  std::string said;
};
Ran finished(std::FILE* program) {
  std::string said;
  std::array<char, 4096> piece{};
  while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), program))
    said.append(piece.data(), n);
  const int status = ::pclose(program);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, said};
}
Ran shell(const std::string& command) {
  return finished(::popen((command + " 2>&1").c_str(), "r"));
}

/// A server with three simulated trials, which are released to research in full.
class ExportOverHttp : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    world_ = std::make_unique<ServedWorld>();
    server_ = std::make_unique<ServerProcess>(world_->data);
    Client client;
    client.speak_to(server_->port());
    for (int i = 0; i < kTrials; ++i) hand_over(client, core::new_id());
    admin_ = world_->admin(client);
    wait_for_scores(client);
  }
  static void TearDownTestSuite() {
    server_.reset();
    world_.reset();
  }
  static void hand_over(Client& client, const std::string& id) {
    const std::string bytes = trial_bytes(world_->folder, id, world_->case_id, kSamples);
    constexpr std::size_t kPiece = 1u << 20;
    ASSERT_EQ(announce(client, world_->station_1, id, world_->case_id, bytes).status, 200);
    for (std::size_t at = 0; at < bytes.size(); at += kPiece)
      ASSERT_EQ(send_piece(client, world_->station_1, id, at, bytes.substr(at, kPiece)).status,
                200);
    ASSERT_EQ(commit(client, world_->station_1, id).status, 200);
  }
  static void wait_for_scores(Client& client) {
    for (int i = 0; i < 1200; ++i) {
      const std::string scores = client.ask("GET", "/api/v1/export/scores.csv", admin_).body;
      const auto trials = client.ask("GET", "/api/v1/trials", admin_).body;
      if (!scores.empty() && trials.find("assessing") == std::string::npos) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    FAIL() << "the trials are not scored within a minute";
  }
  /// "curl …" of the cohort with every sample; `more` are further options.
  static std::string curl(const std::string& more) {
    std::string out = "curl -sS " + more;
    for (const auto& [name, value] : admin_) out += fmt::format(" -H '{}: {}'", name, value);
    return out + fmt::format(" 'http://127.0.0.1:{}/api/v1/export/cohort.zip?tier=full'",
                             server_->port());
  }
  static std::string downloaded(const std::string& name) {
    const fs::path to = world_->folder / name;
    const Ran ran = shell(curl("-o " + to.string()));
    EXPECT_EQ(ran.code, 0) << ran.said;
    return to.string();
  }
  /// Files of trials that the server has open.
  static int open_objects() {
    int out = 0;
    std::error_code gone;
    for (const auto& entry : fs::directory_iterator(fmt::format("/proc/{}/fd", server_->pid())))
      out += fs::read_symlink(entry, gone).string().find("/objects/") != std::string::npos;
    return out;
  }

  static inline std::unique_ptr<ServedWorld> world_;
  static inline std::unique_ptr<ServerProcess> server_;
  static inline Headers admin_;
};

TEST_F(ExportOverHttp, UnzipAndPythonReadItAndTheServerStaysSmall) {
  const auto before = server_->peak_memory_bytes();
  const std::string zip = downloaded("whole.zip");
  EXPECT_GT(fs::file_size(zip), kTrials * kArray_bytes);
  EXPECT_LT(server_->peak_memory_bytes(), before + kArray_bytes) << "less than one of the arrays";
  const Ran tested = shell("unzip -tqq " + zip);
  EXPECT_EQ(tested.code, 0) << tested.said;
  const Ran read = shell(
      "python3 -c \"import sys, zipfile\nfile = "
      "zipfile.ZipFile(sys.argv[1])\nprint(file.testzip(), "
      "[one.file_size for one in file.infolist() if one.filename.startswith('samples/')])\" " +
      zip);
  EXPECT_EQ(read.said,
            fmt::format("None [{}, {}, {}]\n", kArray_bytes, kArray_bytes, kArray_bytes));
}

TEST_F(ExportOverHttp, CurlGoesOnWhereADownloadBroke) {
  const std::string whole = downloaded("unbroken.zip");
  const std::string part = (world_->folder / "part.zip").string(), heads = part + ".heads";
  shell(curl("-N -D " + heads) + " | head -c 30000000 > " + part);
  ASSERT_EQ(fs::file_size(part), 30'000'000u);
  for (int i = 0; i < 200 && open_objects() > 0; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(open_objects(), 0) << "the server still works for a client that went away";

  const Ran tag = shell("sed -n 's/^ETag: //pi' " + heads + " | tr -d '\\r\\n'");
  const Ran resumed = shell(curl("-C - -o " + part + " -H 'If-Range: " + tag.said + "'"));
  EXPECT_EQ(resumed.code, 0) << resumed.said;
  EXPECT_EQ(shell("cmp " + part + " " + whole).said, "");

  fs::resize_file(part, 100);
  // 33: "HTTP server does not seem to support byte ranges" (curl(1))
  EXPECT_EQ(shell(curl("-C - -o " + part)).code, 33) << "without If-Range";
  EXPECT_EQ(shell(curl("-C - -o " + part + " -H 'If-Range: \"another\"'")).code, 33);
}

TEST_F(ExportOverHttp, CurlSaysThatADownloadWasEnded) {
  const auto whole = fs::file_size(downloaded("all.zip"));
  const fs::path part = world_->folder / "ended.zip";
  std::FILE* running = ::popen(curl("--limit-rate 5M -o " + part.string()).c_str(), "r");
  std::error_code not_yet;
  for (int i = 0; i < 200 && (!fs::exists(part) || fs::file_size(part, not_yet) < 1'000'000); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  // A trial of a person who said nothing is not released.
  const auto connection = world_->connection();
  ASSERT_TRUE(connection->query("update trials set simulated = 0", {}));
  // 18: "Partial file. Only a part of the file was transferred." (curl(1))
  EXPECT_EQ(finished(running).code, 18);
  EXPECT_LT(fs::file_size(part), whole);
  ASSERT_TRUE(connection->query("update trials set simulated = 1", {}));
}

}  // namespace
}  // namespace tractus
