/// The PACS: settings, what is asked of it, what it says and does not say. tests/dicomweb tries a
/// real one.
#include "server/api/volumes/pacs.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "server/api/people/people_test_support.hpp"
#include "server/api/volumes/pacs_imports.hpp"

namespace tractus {
namespace api {
namespace {
namespace fs = std::filesystem;
using testing::PeopleTest;

/// Takes one connection, reads a request, says its piece, and is silent until the other side
/// closes.
class OncePeer {
 public:
  explicit OncePeer(std::string says) : says_(std::move(says)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listening_, 4), 0);
    EXPECT_EQ(::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    base = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/dicom-web";
    thread_ = std::thread([this] { answer(); });
  }
  ~OncePeer() {
    ::shutdown(listening_, SHUT_RDWR);
    thread_.join();
    ::close(listening_);
  }
  OncePeer(const OncePeer&) = delete;
  OncePeer& operator=(const OncePeer&) = delete;

  std::string base;
  std::string asked;  ///< head of the request; read it after the answer

 private:
  void answer() {
    const int fd = ::accept(listening_, nullptr, nullptr);
    if (fd < 0) return;
    std::array<char, 4096> piece{};
    while (asked.find("\r\n\r\n") == std::string::npos) {
      const ssize_t n = ::read(fd, piece.data(), piece.size());
      if (n <= 0) break;
      asked.append(piece.data(), std::size_t(n));
    }
    (void)!::write(fd, says_.data(), says_.size());
    while (::read(fd, piece.data(), piece.size()) > 0) {
    }
    ::close(fd);
  }
  std::string says_;
  int listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  std::thread thread_;
};

std::string answer_with(const std::string& type, const std::string& body) {
  return "HTTP/1.1 200 OK\r\nContent-Type: " + type +
         "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

class Pacs : public PeopleTest {
 protected:
  core::Result<PacsSettings> settings(const core::Json& json) {
    std::ofstream(folder_.path() / "token") << "abc\n";
    std::ofstream(folder_.path() / "pacs.json") << json.dump();
    return read_pacs_settings(folder_.path() / "pacs.json");
  }
  fs::path new_folder() {
    const fs::path out = folder_.path() / core::new_id();
    fs::create_directory(out);
    return out;
  }
};

TEST_F(Pacs, SettingsNameOneAddressAndItsSecretFiles) {
  const core::Json good{{"format", "tractus-pacs/1"},
                        {"base", "https://pacs.example/dicom-web/"},
                        {"token_file", "token"},
                        {"authority", "ca.pem"}};
  const auto read = settings(good);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->base, "https://pacs.example/dicom-web");
  EXPECT_EQ(read->token, "abc");
  EXPECT_EQ(read->authority, folder_.path() / "ca.pem");
  for (const auto& [key, value] : std::map<std::string, core::Json>{
           {"base", "http://pacs.example"},  // a token would travel in plain text
           {"base", "https://user@pacs.example"},
           {"base", "https://pacs.example/?a=b"},
           {"format", "tractus-pacs/2"},
           {"user", "without a password"},
           {"token_file", "is_not_there"},
           {"tokn_file", "token"}}) {
    core::Json bad = good;
    bad[key] = value;
    EXPECT_FALSE(settings(bad)) << key << " " << value;
  }
}

TEST_F(Pacs, StudiesAreAskedForByTagAndReadAsFarAsTheySayAnything) {
  OncePeer peer(answer_with("application/dicom+json; charset=utf-8", R"([
    {"0020000D": {"vr": "UI", "Value": ["1.2.3"]}, "00080020": {"vr": "DA", "Value": ["20240314"]},
     "00081030": {"vr": "LO", "Value": [" spine "]}, "00080061": {"vr": "CS", "Value": ["CT", "SR"]},
     "00201206": {"vr": "IS", "Value": ["2"]}, "00201208": {"vr": "IS", "Value": [64]},
     "00100010": {"vr": "PN", "Value": [{"Alphabetic": "Mustermann^Erika"}]}},
    {"0020000D": {"vr": "UI", "Value": ["1.2.4"]}, "00080020": {"vr": "DA"}},
    {"0020000D": {"vr": "UI", "Value": ["../1"]}}, {"0020000D": 7}, [], null])"));
  const auto found =
      find_studies({.base = peer.base, .token = "abc"},
                   {.patient_id = "4711 a", .from = "2024-01-01", .description = "spine L3/4 für"});
  ASSERT_TRUE(found) << found.error().what;
  ASSERT_EQ(found->size(), 2u);  // those that can be asked for
  const PacsStudy& first = found->front();
  EXPECT_EQ(first.date, "2024-03-14");
  EXPECT_EQ(first.description, "spine");
  EXPECT_EQ(first.modalities, (std::vector<std::string>{"CT", "SR"}));
  EXPECT_EQ(first.series, 2u);
  EXPECT_EQ(first.files, 64u);
  EXPECT_EQ(found->back().date, "");
  EXPECT_FALSE(found->back().series);
  EXPECT_TRUE(peer.asked.starts_with(
      "GET /dicom-web/studies?StudyDescription=*spine?L3?4?f?r*&PatientID=4711%20a&"
      "StudyDate=20240101-&includefield=00081030&"))
      << peer.asked;
  EXPECT_NE(peer.asked.find("\r\nAuthorization: Bearer abc\r\n"), std::string::npos) << peer.asked;
}

TEST_F(Pacs, LengthsOfASeriesAreInMetres) {
  OncePeer peer(answer_with("application/dicom+json", R"([
    {"0020000E": {"vr": "UI", "Value": ["1.2.3.4"]}, "00280030": {"vr": "DS", "Value": [0.5, "0.25"]},
     "00180050": {"vr": "DS", "Value": [3]}, "00180088": {"vr": "DS", "Value": [-1]}}])"));
  const auto found = series_of({.base = peer.base}, "1.2.3");
  ASSERT_TRUE(found) << found.error().what;
  ASSERT_EQ(found->size(), 1u);
  EXPECT_DOUBLE_EQ(found->front().row_spacing_m.value_or(0.0), 0.0005);
  EXPECT_DOUBLE_EQ(found->front().column_spacing_m.value_or(0.0), 0.00025);
  EXPECT_DOUBLE_EQ(found->front().thickness_m.value_or(0.0), 0.003);
  EXPECT_FALSE(found->front().slice_spacing_m);  // no distance
}

TEST_F(Pacs, OneThatFallsSilentIsLeftAlone) {
  OncePeer peer(
      "HTTP/1.1 200 OK\r\nContent-Type: multipart/related; boundary=b\r\n\r\n--b\r\nContent-Type: "
      "application/dicom\r\n\r\nDICM");
  const auto fetched = fetch_series(
      {.base = peer.base, .silence = std::chrono::seconds(1)},
      {.study_uid = "1.2", .series_uid = "1.3", .folder = new_folder(), .may_go_on = [](auto) {
         return true;
       }});
  ASSERT_FALSE(fetched);
  EXPECT_EQ(fetched.error().code, core::Errc::unavailable);
  EXPECT_NE(fetched.error().what.find("does not answer"), std::string::npos)
      << fetched.error().what;
}

TEST_F(Pacs, ATransferIsEndedByWhoWantsItNoMore) {
  OncePeer peer("HTTP/1.1 200 OK\r\nContent-Type: multipart/related; boundary=b\r\n\r\n");
  const auto fetched = fetch_series({.base = peer.base}, {.study_uid = "1.2",
                                                          .series_uid = "1.3",
                                                          .folder = new_folder(),
                                                          .may_go_on = [](auto) { return false; }});
  ASSERT_FALSE(fetched);
  EXPECT_EQ(fetched.error().code, core::Errc::cancelled) << fetched.error().what;
}

TEST_F(Pacs, AnImportWhoseServerEndedHasFailed) {
  const store::PacsImport begun{.id = std::string(32, 'a'), .account_id = "fay"};
  ASSERT_TRUE(store_.write([&](store::Writing& tx) { return store::add_pacs_import(tx, begun); }));
  const auto seen = [&](const std::string& account, std::int64_t minutes) {
    return store_
        .read([&](store::Reading& tx) {
          return store::pacs_import_of(tx, account, begun.id, minutes * 60'000'000);
        })
        .value();
  };
  EXPECT_EQ(seen("fay", 1)->state, store::PacsImportState::fetching);
  EXPECT_EQ(seen("fay", 3)->state, store::PacsImportState::failed);
  EXPECT_NE(seen("fay", 3)->error, "");
  EXPECT_FALSE(seen("flo", 1));
}

TEST_F(Pacs, OneImportRunsAtATimeAndWhatIsWrongWithItIsShown) {
  OncePeer peer("HTTP/1.1 200 OK\r\nContent-Type: multipart/related; boundary=b\r\n\r\n");
  PacsImports pacs(backend_, {.base = peer.base});
  backend_.pacs = &pacs;
  const core::Json wish{{"study_uid", "1.2"}, {"series_uid", "1.3"}, {"name", "L3"}};
  const auto begun = post("fay", "/pacs/imports", wish);
  ASSERT_EQ(begun.status, 202) << text(begun);
  EXPECT_EQ(post("dora", "/pacs/imports", wish).status, 503);
  EXPECT_EQ(post("fay", "/pacs/imports", {{"study_uid", "1.2"}, {"series_uid", "1/3"}}).status,
            400);
  const std::string id = json(begun).value("id", "");
  EXPECT_EQ(json(get("fay", "/pacs/imports/" + id))["state"], "fetching");
  EXPECT_EQ(get("dora", "/pacs/imports/" + id).status, 404);
}

TEST_F(Pacs, NoneIsSaid) {
  EXPECT_TRUE(json(get("fay", "/pacs"))["address"].is_null());
  EXPECT_EQ(post("fay", "/pacs/studies", {{"patient_id", "1"}}).status, 409);
  EXPECT_EQ(get("tom", "/pacs").status, 403);
}

}  // namespace
}  // namespace api
}  // namespace tractus
