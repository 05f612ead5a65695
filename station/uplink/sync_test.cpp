#include "station/uplink/sync.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "cases/case.hpp"
#include "core/file.hpp"
#include "station/uplink/double_server.hpp"

namespace tractus {
namespace uplink {
namespace {
namespace fs = std::filesystem;

/// A server with one signed case, made by the product's own writer, and a station without any.
class Syncing : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "sync-XXXXXX";
    root_ = ::mkdtemp(name.data());
    fs::create_directories(cases());
    volume::Volume volume;
    volume.geometry.dims = {8, 8, 8};
    volume.geometry.spacing_m = {0.001, 0.001, 0.001};
    volume.counts.assign(512, 7);
    key_ = core::KeyPair::generate();
    cases::NewCase made{.definition = {}, .truth = {}, .volume = volume, .meta = {}, .draw = {}};
    made.definition.title = "a cube";
    made.definition.source = "made by this test";
    made.definition.tract.length_m = 0.005;
    made.definition.tract.radius_m = 0.001;
    auto opened = cases::write_case(root_ / "made", made, key_);
    ASSERT_TRUE(opened) << opened.error().what;
    id_ = opened->id;
    const std::string at = "/api/v1/cases/" + id_;
    put("/api/v1/cases", core::Json{{"cases", {{{"id", id_}, {"title", "a cube"}}}}}.dump());
    server_.files[at] = file("case.json");
    server_.files[at + "/parts/case.sig"] = file("case.sig");
    for (const auto& part : opened->definition.parts)
      server_.files[at + "/parts/" + part.name] = file(part.name);
  }
  void TearDown() override { fs::remove_all(root_); }
  void put(const std::string& path, const std::string& text) {
    const auto bytes = core::bytes_of(text);
    server_.files[path] = core::Bytes(bytes.begin(), bytes.end());
  }
  core::Bytes file(const std::string& name) { return *core::read_file(root_ / "made" / name); }
  fs::path cases() const { return root_ / "cases"; }
  core::Result<SyncReport> sync() { return sync_cases(server_, cases(), {key_.public_hex}); }
  bool nothing_left() const { return fs::directory_iterator(cases()) == fs::directory_iterator(); }

  fs::path root_;
  core::KeyPair key_;
  DoubleServer server_;
  std::string id_;
};

TEST_F(Syncing, FetchesAVerifiedCaseWithoutItsTruth) {
  const auto report = sync();
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->fetched, std::vector<std::string>{id_});
  EXPECT_TRUE(fs::exists(cases() / id_ / "volume.tvol"));
  EXPECT_FALSE(fs::exists(cases() / id_ / "truth.json"));
  for (const auto& line : server_.log)
    EXPECT_EQ(line.find("truth"), std::string::npos) << "the truth was asked for";
  const auto opened = cases::open_case(cases() / id_);
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->id, id_);
}

TEST_F(Syncing, FetchesNothingTwice) {
  ASSERT_TRUE(sync());
  server_.log.clear();
  const auto again = sync();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->present.size(), 1u);
  EXPECT_EQ(server_.log.size(), 1u);
}

TEST_F(Syncing, RefusesASignerThatIsNotTrusted) {
  const auto report = sync_cases(server_, cases(), {core::KeyPair::generate().public_hex});
  ASSERT_TRUE(report);
  ASSERT_EQ(report->refused.size(), 1u);
  EXPECT_NE(report->refused[0].find("does not trust"), std::string::npos);
  EXPECT_TRUE(nothing_left());
}

TEST_F(Syncing, RefusesAChangedPartAndLeavesNothing) {
  auto& part = server_.files["/api/v1/cases/" + id_ + "/parts/volume.tvol"];
  part[part.size() / 2] ^= std::byte{1};
  const auto report = sync();
  ASSERT_TRUE(report);
  ASSERT_EQ(report->refused.size(), 1u);
  EXPECT_NE(report->refused[0].find("volume.tvol"), std::string::npos);
  EXPECT_TRUE(nothing_left());
}

TEST_F(Syncing, RefusesAManifestOfAnotherName) {
  auto& manifest = server_.files["/api/v1/cases/" + id_];
  manifest.push_back(std::byte{' '});
  const auto report = sync();
  ASSERT_TRUE(report);
  EXPECT_EQ(report->refused.size(), 1u);
  EXPECT_TRUE(nothing_left());
}

TEST_F(Syncing, IsWholeOrAbsentWhicheverRequestIsCut) {
  bool cut = true;
  for (int n = 1; cut; ++n) {
    ASSERT_LT(n, 50);
    fs::remove_all(cases() / id_);
    server_.fail_at = n;
    const auto report = sync();
    cut = !report;
    EXPECT_TRUE(!cut || nothing_left()) << "after request " << n;
  }
  EXPECT_TRUE(cases::open_case(cases() / id_));
}

TEST_F(Syncing, RefusesAListThatIsNoList) {
  for (const char* text :
       {"[]", "{}", R"({"cases":[{"id":"../../etc"}]})", R"({"cases":[1]})", "<html>"}) {
    put("/api/v1/cases", text);
    EXPECT_FALSE(sync()) << text;
  }
}

/// Two cases of 128³ voxels, eight bricks each, that differ in one: a carving and one more.
class SyncingMuch : public Syncing {
 protected:
  void SetUp() override {
    Syncing::SetUp();
    first_ = make("first", 0);
    second_ = make("second", 1);
  }
  /// Noise, so that a brick stays as large packed as it is.
  std::string make(const std::string& name, std::uint16_t changed) {
    volume::Volume volume;
    volume.geometry.dims = {128, 128, 128};
    volume.geometry.spacing_m = {0.001, 0.001, 0.001};
    volume.counts.resize(volume.geometry.voxel_count());
    std::uint32_t state = 1;
    for (auto& count : volume.counts) {
      state = state * 1664525u + 1013904223u;
      count = static_cast<std::uint16_t>(state >> 16);
    }
    volume.counts[0] = static_cast<std::uint16_t>(volume.counts[0] + changed);
    cases::NewCase made{.definition = {}, .truth = {}, .volume = volume, .meta = {}, .draw = {}};
    made.definition.title = name;
    made.definition.source = "made by this test";
    made.definition.tract.length_m = 0.005;
    made.definition.tract.radius_m = 0.001;
    const auto opened = cases::write_case(root_ / name, made, key_);
    EXPECT_TRUE(opened);
    const std::string at = "/api/v1/cases/" + opened->id;
    const auto bytes = [&](const std::string& file) {
      return *core::read_file(root_ / name / file);
    };
    server_.files[at] = bytes("case.json");
    server_.files[at + "/parts/case.sig"] = bytes("case.sig");
    for (const auto& part : opened->definition.parts)
      server_.files[at + "/parts/" + part.name] = bytes(part.name);
    return opened->id;
  }
  void offer(const std::string& id) {
    put("/api/v1/cases", core::Json{{"cases", {{{"id", id}, {"title", "x"}}}}}.dump());
  }
  fs::path incoming(const std::string& id) const { return root_ / "incoming" / id; }

  std::string first_, second_;
};

TEST_F(SyncingMuch, FetchesOnlyTheBricksThatChanged) {
  offer(first_);
  const auto whole = sync();
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->fetched.size(), 1u);
  EXPECT_EQ(whole->bytes_fetched, whole->bytes_of_cases);
  offer(second_);
  const auto changed = sync();
  ASSERT_TRUE(changed);
  ASSERT_EQ(changed->fetched.size(), 1u) << changed->to_json().dump();
  // One brick of eight, and the head with its index.
  EXPECT_LT(changed->bytes_fetched, changed->bytes_of_cases / 7);
  EXPECT_GT(changed->bytes_fetched, changed->bytes_of_cases / 9);
  EXPECT_TRUE(cases::open_case(cases() / second_));
}

TEST_F(SyncingMuch, GoesOnWithinAPartThatWasCut) {
  offer(first_);
  server_.fail_at = 5;  // list, manifest, signature, a piece of 4 MiB, then the cut
  ASSERT_FALSE(sync());
  EXPECT_EQ(fs::file_size(incoming(first_) / "volume.tvol"), 4u << 20);
  const auto rest = sync();
  ASSERT_TRUE(rest);
  ASSERT_EQ(rest->fetched.size(), 1u);
  EXPECT_EQ(rest->bytes_fetched, rest->bytes_of_cases - (4u << 20));
  EXPECT_FALSE(fs::exists(incoming(first_)));
}

TEST_F(SyncingMuch, WhatADyingDiskMadeOfABeginningIsFetchedAnew) {
  offer(first_);
  server_.fail_at = 5;
  ASSERT_FALSE(sync());
  {
    std::fstream file(incoming(first_) / "volume.tvol", std::ios::in | std::ios::out);
    file.seekp(1000);
    file.put('!');
  }
  const auto rest = sync();
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->fetched.size(), 1u) << rest->to_json().dump();
  EXPECT_TRUE(cases::open_case(cases() / first_));
}

TEST_F(SyncingMuch, IsRefusedBeforeAnythingIsFetchedWhereTheDiskHasNoRoom) {
  offer(first_);
  const SyncLimits limits{.reserve_bytes = 100u << 20, .free_bytes = [] { return 101ull << 20; }};
  const auto report = sync_cases(server_, cases(), {key_.public_hex}, {}, limits);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, core::Errc::io);
  EXPECT_NE(report.error().what.find("make room first"), std::string::npos);
  for (const auto& line : server_.log)
    EXPECT_EQ(line.find("volume.tvol"), std::string::npos) << line;
  EXPECT_TRUE(nothing_left());
}

}  // namespace
}  // namespace uplink
}  // namespace tractus
