/// A station that hands trials over, one after the other, to servers that may die at any moment.
#pragma once

#include <gtest/gtest.h>

#include <atomic>

#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus::fault {
using namespace world;

constexpr std::uint32_t kSamples = 400;
constexpr std::size_t kPieces = 10;  // and a commit a trial

/// What the station knows of the trial it is handing over.
struct HandOver {
  std::string id, file;
  bool announced = false;
  std::size_t acknowledged = 0;
};

class KilledServer {
 public:
  KilledServer() = default;
  /// With its records in this PostgreSQL database.
  explicit KilledServer(const std::string& address) : world_(address) {}
  /// Goes on handing over until the connection breaks; `steps` counts the requests begun.
  void hand_over(Client& client, std::atomic<int>& steps) {
    do ++steps;
    while (step(client));
  }
  /// What must hold whenever the server is up again.
  void check(Client& client) {
    if (now_.announced) {
      const Answer state = client.ask("GET", upload_path(now_.id), world_.station_1);
      ASSERT_EQ(state.status, 200) << state.body;
      const auto offset = state.json()["offset_bytes"].get<std::size_t>();
      EXPECT_GE(offset, now_.acknowledged) << "acknowledged bytes are gone";
      now_.acknowledged = offset;
    }
    check_trials(client);
  }
  /// A few steps more, at whoever answers.
  void go_on(Client& client, int steps) {
    for (int i = 0; i < steps && !::testing::Test::HasFailure(); ++i)
      EXPECT_TRUE(step(client)) << "the other server does not go on";
  }
  const Headers& admin() const { return admin_; }
  int trials_done() const { return done_; }
  const ServedWorld& world() const { return world_; }
  void sign_in(Client& client) { admin_ = world_.admin(client); }
  /// Kept up for the last trial.
  void finish(Client& client) {
    const int before = done_;
    while (done_ == before && step(client)) {
    }
    EXPECT_EQ(done_, before + 1);
    check_trials(client);
  }

 private:
  bool step(Client& client) {
    if (now_.id.empty()) {
      now_.id = core::new_id();
      now_.file = trial_bytes(world_.folder, now_.id, world_.case_id, kSamples);
    }
    if (!now_.announced) {
      const Answer answer = announce(client, world_.station_1, now_.id, world_.case_id, now_.file);
      now_.announced = answer.status == 200;
      return now_.announced;
    }
    if (now_.acknowledged < now_.file.size()) {
      const Answer answer =
          send_piece(client, world_.station_1, now_.id, now_.acknowledged,
                     now_.file.substr(now_.acknowledged, now_.file.size() / kPieces + 1));
      if (answer.status == 0) return false;
      if (answer.status == 409) return went_on(answer);
      EXPECT_EQ(answer.status, 200) << answer.body;
      if (answer.status == 200)
        now_.acknowledged = answer.json()["offset_bytes"].get<std::size_t>();
      return answer.status == 200;
    }
    const Answer answer = commit(client, world_.station_1, now_.id);
    if (answer.status == 0) return false;
    EXPECT_EQ(answer.status, 200) << answer.body;
    ++done_;
    now_ = {};
    return answer.status == 200;
  }

  /// The last piece of a server that was killed may be noted a moment after it was asked how far it
  /// is: another server then says where to go on, and a station does.
  bool went_on(const Answer& answer) {
    const std::size_t offset = answer.json().value("offset_bytes", std::size_t{0});
    EXPECT_GT(offset, now_.acknowledged) << answer.body;
    now_.acknowledged = offset;
    return !::testing::Test::HasFailure();
  }

  /// As many as were acknowledged, and perhaps the one whose acknowledgement was cut off; each
  /// whole.
  void check_trials(Client& client) {
    core::Json trials = core::Json::array();
    for (std::string cursor, next = "first"; !next.empty(); cursor = "&cursor=" + next) {
      const Answer list = client.ask("GET", "/api/v1/trials?limit=200" + cursor, admin_);
      ASSERT_EQ(list.status, 200) << list.body;
      const core::Json page = list.json();
      for (const auto& trial : page.at("trials")) trials.push_back(trial);
      next = page.at("next").is_string() ? page.at("next").get<std::string>() : "";
    }
    const auto done = static_cast<std::size_t>(done_);
    EXPECT_GE(trials.size(), done);
    EXPECT_LE(trials.size(), done + 1);
    for (const auto& trial : trials) {
      EXPECT_EQ(trial["samples"], kSamples);
      EXPECT_NE(trial["state"], "failed");
    }
    if (trials.empty()) return;
    const auto newest = "/api/v1/trials/" + trials[0]["id"].get<std::string>();
    EXPECT_EQ(client.ask("GET", newest, admin_).json()["events"].size(), 3u);
    EXPECT_EQ(client.ask("GET", newest + "/signals?points=400", admin_).json()["t_s"].size(),
              kSamples);
  }

  ServedWorld world_;
  Headers admin_;
  HandOver now_;
  int done_ = 0;
};

}  // namespace tractus::fault
