/// A server without sockets, with an admin, two stations and a clock of the test's own.
#pragma once

#include <gtest/gtest.h>

#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/coverage.hpp"
#include "db/store/store_test_support.hpp"
#include "server/api/backend.hpp"
#include "server/api/people/authentication.hpp"
#include "server/api/service.hpp"
#include "server/live/hub.hpp"
#include "tests/support/database/database.hpp"

namespace tractus::api::testing {

inline const std::string kCase(64, 'c');
inline const std::string kPassword = "correct horse";

class ApiTest : public ::testing::Test {
 protected:
  ApiTest() {
    const std::string hash = quick_hash();
    auto furnished = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_account(tx, {"1", "ada", Role::admin, hash}, 0));
      TRY(store::add_station(tx, {"s1", "station-1"}, token_hash("token-1"), 0));
      TRY(store::add_station(tx, {"s2", "station-2"}, token_hash("token-2"), 0));
      return store::add_case(tx, {kCase, "L3", "made", 1, 0}, {}, 0);
    });
    EXPECT_TRUE(furnished);
    EXPECT_TRUE(store::begin_coverage(store_));
  }
  /// Whatever a test had the server do: the audit trail has it.
  void TearDown() override {
    std::vector<std::string> findings;
    const auto compared = store_.read([&](store::Reading& tx) -> core::Result<void> {
      store::TrailDigests digests;
      TRY(store::verify_chain(tx, store_.audit_key(),
                              [&](const store::AuditRow& row) { digests.add(row); }));
      return digests.compare(tx, store_.audit_key(), findings);
    });
    EXPECT_TRUE(compared) << compared.error().what;
    for (const std::string& line : findings) ADD_FAILURE() << line;
  }

  /// Hashed once: 64 MiB each time would make the tests slow.
  static std::string quick_hash() {
    static const std::string hash = password_hash(kPassword).value();
    return hash;
  }

  http::Request request(const std::string& method, const std::string& target,
                        std::map<std::string, std::string> headers = {}, std::string body = "") {
    http::Request out;
    out.method = method;
    out.headers = std::move(headers);
    out.body = std::move(body);
    out.peer = "127.0.0.1";
    EXPECT_TRUE(http::read_target(target, out));
    return out;
  }
  http::Response ask(const http::Request& asked) { return answer(backend_, routes(), asked); }
  http::Response sign_in_as(const std::string& name, const std::string& password) {
    return ask(request("POST", "/api/v1/session", {{"content-type", "application/json"}},
                       core::Json{{"name", name}, {"password", password}}.dump()));
  }
  /// "tractus_session=…" of a new session.
  std::string cookie() {
    const http::Response in = sign_in_as("ada", kPassword);
    EXPECT_EQ(in.status, 200);
    const std::string set(in.header("Set-Cookie"));
    return set.substr(0, set.find(';'));
  }
  static std::map<std::string, std::string> station(const std::string& token) {
    return {{"authorization", "Bearer " + token}};
  }
  static std::string text(const http::Response& response) {
    if (const auto* held = std::get_if<std::string>(&response.body)) return *held;
    if (const auto* made = std::get_if<http::MadeBody>(&response.body)) return text(*made);
    const auto& slice = std::get<http::FileSlice>(response.body);
    const auto bytes = core::read_file(slice.path).value();
    return std::string(core::text_of(bytes)).substr(slice.offset, slice.size);
  }
  /// What the server sends of it: all, or as much as comes before an error.
  static std::string text(const http::MadeBody& body) {
    std::string out, piece;
    while (out.size() < body.size && body.source->read(piece)) out += piece;
    EXPECT_LE(out.size(), body.size);
    return out;
  }
  static core::Json json(const http::Response& response) {
    return core::Json::parse(text(response), nullptr, false);
  }

  store::testing::TestFolder folder_;
  test_support::TestDatabase database_;
  store::Store store_ = database_.open();
  store::Objects objects_ = std::move(store::Objects::open(folder_.path()).value());
  store::PartialFiles partials_ = std::move(store::PartialFiles::open(folder_.path()).value());
  std::int64_t now_ = 1'000'000'000'000'000;
  int woken_ = 0;
  live::Hub hub_{{.store = store_, .now_utc_us = [this] { return now_; }}};
  Backend backend_{.store = store_,
                   .objects = objects_,
                   .partials = partials_,
                   .now_utc_us = [this] { return now_; },
                   .work_waits = [this] { ++woken_; },
                   .live = &hub_};
};

}  // namespace tractus::api::testing
