#include "station/uplink/upload.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <condition_variable>
#include <mutex>
#include <set>

#include "core/file.hpp"
#include "station/uplink/double_server.hpp"
#include "station/uplink/http_server.hpp"

namespace tractus {
namespace uplink {
namespace {
namespace fs = std::filesystem;
const std::string kCase = core::sha256(core::bytes_of("a case"));
const std::string kFirst = "000000000001" + std::string(20, 'a');
const std::string kSecond = "000000000002" + std::string(20, 'b');

core::Bytes bytes_of_size(std::size_t size, unsigned seed) {
  core::Bytes out(size);
  for (std::size_t i = 0; i < size; ++i) out[i] = std::byte((i * 2654435761u + seed) >> 7 & 255u);
  return out;
}

/// A station's folders with two finished trials: 3.2 MB (four chunks) and 1 kB.
class Uploading : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "upload-XXXXXX";
    root_ = ::mkdtemp(name.data());
    fs::create_directories(root_ / "trials");
    fs::create_directories(root_ / "outbox");
    outbox_ = std::make_unique<Outbox>(root_ / "outbox");
    put(kSecond, bytes_of_size(1000, 2));
    put(kFirst, bytes_of_size(3'200'000, 1));
  }
  void TearDown() override { fs::remove_all(root_); }
  void put(const std::string& id, const core::Bytes& bytes) {
    const fs::path file = trials() / (id + ".ttrial");
    ASSERT_TRUE(core::write_file(file, bytes));
    ASSERT_TRUE(outbox_->queue(id, kCase, file));
    bytes_[id] = bytes;
  }
  fs::path trials() const { return root_ / "trials"; }
  core::Result<UploadReport> upload(Server& server, core::Instant_ns patience_ns = 0) {
    return upload_all({&server}, *outbox_, trials(), clock_, {.give_up_after_ns = patience_ns});
  }
  void expect_handed_over_once(const DoubleServer& server) {
    for (const auto& [id, bytes] : bytes_) {
      ASSERT_TRUE(server.committed.contains(id)) << id;
      EXPECT_EQ(server.committed.at(id), bytes) << id;
      EXPECT_EQ(server.commits.at(id), 1) << id;
      EXPECT_TRUE(fs::exists(trials() / (id + ".ttrial"))) << "a trial was deleted";
    }
    const auto entries = outbox_->entries();
    ASSERT_TRUE(entries);
    for (const auto& entry : *entries) EXPECT_EQ(entry.state, OutboxState::complete);
  }

  fs::path root_;
  std::unique_ptr<Outbox> outbox_;
  std::map<std::string, core::Bytes> bytes_;
  core::ManualClock clock_;
};

TEST_F(Uploading, HandsOverEveryTrialOldestFirst) {
  DoubleServer server;
  const auto report = upload(server);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->handed_over, 2);
  expect_handed_over_once(server);
  EXPECT_NE(server.log.front().find(kFirst), std::string::npos);
  EXPECT_NE(server.log.back().find(kSecond), std::string::npos);
}

/// Notes the header traceparent of each request.
class NotingTraces final : public Server {
 public:
  core::Result<HttpResponse> send(const Request& request) override {
    std::string found;
    for (const auto& [name, value] : request.headers)
      if (name == "traceparent") found = value;
    headers.push_back(found);
    return server.send(request);
  }
  DoubleServer server;
  std::vector<std::string> headers;
};

TEST_F(Uploading, EachTrialIsATraceWhichItsRequestsName) {
  NotingTraces noting;
  std::string sent;
  {
    tracing::Tracer tracer(
        {.url = "http://c/v1/traces"},
        [&](const std::string& body, auto, const auto&) {
          return sent += body, tracing::Delivered{tracing::Delivery::taken};
        },
        [](const std::string&) {});
    ASSERT_TRUE(upload_all({&noting}, *outbox_, trials(), clock_, {}, {}, {}, &tracer));
  }
  std::set<std::string> traces, spans;
  for (const std::string& header : noting.headers) {
    const auto context = tracing::parse_traceparent(header);
    ASSERT_TRUE(context) << header;
    traces.insert(context->trace_id), spans.insert(context->span_id);
  }
  EXPECT_EQ(noting.headers.size(), 9u);  // announced, four pieces and one, committed
  EXPECT_EQ(traces.size(), 2u);          // of two trials
  EXPECT_EQ(spans.size(), 9u);
  for (const std::string& secret : {kFirst, kSecond, kCase})
    EXPECT_EQ(sent.find(secret), std::string::npos) << sent;
  noting.headers.clear();
  put("000000000003" + std::string(20, 'c'), bytes_of_size(1000, 3));
  ASSERT_TRUE(upload(noting));
  EXPECT_EQ(noting.headers, std::vector<std::string>(3)) << "without a tracer";
}

TEST_F(Uploading, SendsNothingTwiceWhenAllIsHandedOver) {
  DoubleServer server;
  ASSERT_TRUE(upload(server));
  server.log.clear();
  ASSERT_TRUE(upload(server));
  EXPECT_TRUE(server.log.empty());
}

TEST_F(Uploading, ArrivesOnceWhicheverRequestIsCutBeforeOrAfterItTookEffect) {
  for (const auto fault :
       {DoubleServer::InjectedFault::before, DoubleServer::InjectedFault::after}) {
    bool cut = true;
    for (int n = 1; cut; ++n) {
      ASSERT_LT(n, 50);
      TearDown(), bytes_.clear(), SetUp();
      DoubleServer server;
      server.fail_at = n;
      server.fault = fault;
      const auto first = upload(server);
      ASSERT_TRUE(first);
      cut = first->waiting > 0;
      if (cut) {
        EXPECT_FALSE(first->why.empty());
        const auto second = upload(server);
        ASSERT_TRUE(second);
        EXPECT_EQ(second->waiting, 0);
      }
      expect_handed_over_once(server);
    }
  }
}

TEST_F(Uploading, GoesOnWhereTheServerStandsInsteadOfFromTheStart) {
  DoubleServer server;
  server.fail_at = 4;  // announce, two chunks, then the cut
  ASSERT_TRUE(upload(server));
  server.log.clear();
  ASSERT_TRUE(upload(server));
  EXPECT_NE(server.log[1].find("offset_bytes=2097152"), std::string::npos) << server.log[1];
}

TEST_F(Uploading, WaitsLongerAndLongerUntilItsPatienceEnds) {
  class Away final : public Server {
   public:
    explicit Away(core::ManualClock& clock) : clock_(clock) {}
    core::Result<HttpResponse> send(const Request&) override {
      at_s.push_back(static_cast<int>(clock_.now() / 1'000'000'000));
      return core::Error{core::Errc::unavailable, "nobody there"};
    }
    std::vector<int> at_s;

   private:
    core::ManualClock& clock_;
  } away(clock_);
  const auto report = upload(away, 100'000'000'000);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->waiting, 2);
  EXPECT_EQ(away.at_s, (std::vector<int>{0, 1, 3, 7, 15, 31, 63, 123}));  // 1, 2, 4 … 32, then 60
}

TEST_F(Uploading, KeepsATrialThatTheServerRefusesAndTakesTheNext) {
  class Strict final : public Server {
   public:
    core::Result<HttpResponse> send(const Request& request) override {
      if (request.path.find(kFirst) != std::string::npos) {
        const auto bytes =
            core::bytes_of(R"({"error":"another trial has this id","code":"conflict"})");
        return HttpResponse{409, core::Bytes(bytes.begin(), bytes.end())};
      }
      return inner.send(request);
    }
    DoubleServer inner;
  } strict;
  const auto report = upload(strict);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->refused, 1);
  EXPECT_EQ(report->handed_over, 1);
  const auto entries = outbox_->entries();
  ASSERT_TRUE(entries);
  EXPECT_EQ(entries->front().state, OutboxState::refused);
  EXPECT_NE(entries->front().reason.find("another trial has this id"), std::string::npos);
  EXPECT_TRUE(fs::exists(trials() / (kFirst + ".ttrial")));
}

TEST_F(Uploading, DoesNotBelieveAServerWithAnImpossibleOffset) {
  class Liar final : public Server {
   public:
    core::Result<HttpResponse> send(const Request&) override {
      const auto bytes = core::bytes_of(R"({"offset_bytes":99999999,"state":"receiving"})");
      return HttpResponse{200, core::Bytes(bytes.begin(), bytes.end())};
    }
  } liar;
  const auto report = upload(liar);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->waiting, 2);
}

/// One server behind several connections. A piece of the first trial but its first waits until the
/// second trial is announced, if need be for `patience`.
class Shared {
 public:
  class Connection final : public Server {
   public:
    explicit Connection(Shared& shared) : shared_(shared) {}
    core::Result<HttpResponse> send(const Request& request) override {
      return shared_.send(request);
    }

   private:
    Shared& shared_;
  };
  explicit Shared(std::chrono::seconds patience = {}) : patience_(patience) {}
  std::vector<Server*> connections() {
    std::vector<Server*> out;
    for (Connection& one : all_) out.push_back(&one);
    return out;
  }
  std::vector<std::string> committed() const {
    std::vector<std::string> out;
    for (const std::string& line : server.log)
      if (line.ends_with("/commit"))
        out.push_back(line.substr(std::size("POST /api/v1/uploads"), 32));
    return out;
  }
  DoubleServer server;
  bool side_by_side = true;

 private:
  core::Result<HttpResponse> send(const Request& request) {
    std::unique_lock held(mutex_);
    announced_.insert(request.path.substr(std::size("/api/v1/uploads"), 32));
    changed_.notify_all();
    const bool later_piece = request.method == "PATCH" && !request.path.ends_with("offset_bytes=0");
    if (later_piece && patience_.count() > 0)
      side_by_side = side_by_side && changed_.wait_for(held, patience_, [&] {
        return announced_.contains(kSecond);
      });
    return server.send(request);
  }
  std::mutex mutex_;
  std::condition_variable changed_;
  std::set<std::string> announced_;
  std::chrono::seconds patience_;
  std::array<Connection, 3> all_{Connection(*this), Connection(*this), Connection(*this)};
};

TEST_F(Uploading, SeveralConnectionsSendSideBySideAndCommitInOrder) {
  for (int i = 3; i < 12; ++i)
    put(fmt::format("{:012}", i) + std::string(20, 'c'), bytes_of_size(1000, unsigned(i)));
  Shared shared(std::chrono::seconds(20));
  const auto report = upload_all(shared.connections(), *outbox_, trials(), clock_, {});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->handed_over, 11);
  expect_handed_over_once(shared.server);
  EXPECT_TRUE(shared.side_by_side);
  std::vector<std::string> ids;
  for (const auto& [id, bytes] : bytes_) ids.push_back(id);
  EXPECT_EQ(shared.committed(), ids);
}

TEST_F(Uploading, NothingYoungerIsCommittedBeforeWhicheverRequestOfSeveralConnectionsIsCut) {
  for (const auto fault :
       {DoubleServer::InjectedFault::before, DoubleServer::InjectedFault::after}) {
    bool cut = true;
    for (int n = 1; cut; ++n) {
      ASSERT_LT(n, 50);
      TearDown(), bytes_.clear(), SetUp();
      for (int i = 3; i < 7; ++i)
        put(fmt::format("{:012}", i) + std::string(20, 'c'), bytes_of_size(1000, unsigned(i)));
      Shared shared;
      shared.server.fail_at = n;
      shared.server.fault = fault;
      const auto first = upload_all(shared.connections(), *outbox_, trials(), clock_, {});
      ASSERT_TRUE(first);
      cut = first->waiting > 0;
      std::vector<std::string> ids;
      for (const auto& [id, bytes] : bytes_) ids.push_back(id);
      const auto committed = shared.committed();
      ASSERT_LE(committed.size(), ids.size());
      EXPECT_TRUE(std::equal(committed.begin(), committed.end(), ids.begin())) << n;
      if (cut) {
        EXPECT_FALSE(first->why.empty());
        const auto second = upload_all(shared.connections(), *outbox_, trials(), clock_, {});
        ASSERT_TRUE(second);
        EXPECT_EQ(second->waiting, 0);
      }
      expect_handed_over_once(shared.server);
    }
  }
}

TEST_F(Uploading, ATrialThatTheServerRefusesHoldsUpNoOtherConnection) {
  for (int i = 3; i < 7; ++i)
    put(fmt::format("{:012}", i) + std::string(20, 'c'), bytes_of_size(1000, unsigned(i)));
  Shared shared;
  const auto wrong = core::bytes_of("not what was queued, of another size");
  ASSERT_TRUE(core::write_file(trials() / (kSecond + ".ttrial"), wrong));
  const auto report = upload_all(shared.connections(), *outbox_, trials(), clock_, {});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->refused, 1);
  EXPECT_EQ(report->handed_over, 5);
  EXPECT_EQ(report->waiting, 0);
}

TEST(HttpServer, RefusesOtherSchemesPathsAndOddTokens) {
  for (const char* url : {"ftp://host", "file:///etc/passwd", "host:80", "http://", "http://a/b",
                          "http://a b", "http://user@host", "http://a?x=1"})
    EXPECT_FALSE(HttpServer::make(url, "token")) << url;
  EXPECT_FALSE(HttpServer::make("http://host", ""));
  EXPECT_FALSE(HttpServer::make("http://host", "a\r\nX-Evil: 1"));
  EXPECT_TRUE(HttpServer::make("https://host:8443/", "token"));
}

}  // namespace
}  // namespace uplink
}  // namespace tractus
