/// The object store against a real S3 server, Ceph's RADOS gateway.
#include "db/store/volumes/s3_store.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openssl/evp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <random>
#include <thread>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "db/store/volumes/objects.hpp"
#include "tests/support/s3/s3_server.hpp"

namespace tractus {
namespace store {
namespace {
namespace fs = std::filesystem;
using test_support::s3_server;
using ::testing::HasSubstr;
using ::testing::Not;

// SHA-256 of "abc": FIPS 180-4, example B.1; its MD5: RFC 1321, appendix A.5.
const std::string kAbc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
const std::string kAbc_md5 = "900150983cd24fb0d6963f7d28e17f72";
constexpr std::size_t kPart_bytes = 16u << 20;

std::unique_ptr<ObjectStore> opened(const std::string& address, S3Credentials credentials) {
  return open_s3(S3Address::parse(address).value(), std::move(credentials));
}
std::unique_ptr<ObjectStore> opened(const std::string& prefix) {
  const std::string address = s3_server().address(prefix);
  return opened(address, S3Credentials::find().value());
}

/// A file of random bytes.
class RandomFile {
 public:
  explicit RandomFile(std::size_t size_bytes) : bytes(core::random_bytes(size_bytes)) {
    EXPECT_TRUE(core::write_file(path, bytes));
    sha256 = core::sha256(bytes);
  }
  ~RandomFile() { fs::remove(path); }
  RandomFile(const RandomFile&) = delete;
  RandomFile& operator=(const RandomFile&) = delete;
  fs::path path = fs::path(::testing::TempDir()) / ("tractus-" + core::new_id());
  core::Bytes bytes;
  std::string sha256;
};

fs::path abc_file() {
  const fs::path path = fs::path(::testing::TempDir()) / ("tractus-" + core::new_id());
  std::ofstream(path) << "abc";
  return path;
}

core::Result<std::string> read_from(const ObjectStore& store, const std::string& sha256,
                                    std::uint64_t offset = 0,
                                    std::optional<std::uint64_t> size = {}) {
  std::string out;
  auto read = store.read(sha256, offset, size, [&](core::ByteView piece) {
    out += core::text_of(piece);
    return true;
  });
  if (!read) return read.error();
  return out;
}

/// What was read, or why it could not be.
std::string text_of(const ObjectStore& store, const std::string& sha256, std::uint64_t offset = 0,
                    std::optional<std::uint64_t> size = {}) {
  auto read = read_from(store, sha256, offset, size);
  return read ? *read : read.error().what;
}

/// SHA-256 of what is read, or why it cannot be.
std::string sha256_of(const ObjectStore& store, const std::string& sha256) {
  auto read = read_from(store, sha256);
  return read ? core::sha256(core::bytes_of(*read)) : read.error().what;
}

std::string key_of(const std::string& prefix, const std::string& sha256) {
  return prefix + "/" + sha256.substr(0, 2) + "/" + sha256.substr(2);
}

std::string md5(core::ByteView bytes) {
  std::array<std::byte, 16> out{};
  EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(out.data()), nullptr,
             EVP_md5(), nullptr);
  return core::hex(out);
}

TEST(S3Store, PutsReadsAndRemovesAnObject) {
  const auto store = opened("small");
  EXPECT_EQ(store->size_of(kAbc).value(), std::nullopt);
  const fs::path file = abc_file();
  const auto put = store->put(kAbc, file);
  ASSERT_TRUE(put) << put.error().what;
  EXPECT_EQ(s3_server().etag(key_of("small", kAbc)), kAbc_md5);
  EXPECT_TRUE(store->put(kAbc, file)) << "again";
  EXPECT_EQ(store->size_of(kAbc).value(), 3u);
  EXPECT_EQ(text_of(*store, kAbc), "abc");
  EXPECT_EQ(text_of(*store, kAbc, 1, 1), "b");
  EXPECT_EQ(text_of(*store, kAbc, 1), "bc");
  EXPECT_EQ(text_of(*store, kAbc, 1, 0), "");
  EXPECT_EQ(opened("other")->size_of(kAbc).value(), std::nullopt) << "of another prefix";
  ASSERT_TRUE(store->remove(kAbc));
  EXPECT_EQ(s3_server().etag(key_of("small", kAbc)), "");
  EXPECT_EQ(store->size_of(kAbc).value(), std::nullopt);
  EXPECT_EQ(read_from(*store, kAbc).error().code, core::Errc::not_found);
  EXPECT_TRUE(store->remove(kAbc)) << "what is not there is removed already";
}

// The ETag of an object that was put in N parts is the MD5 of its parts' MD5s, and "-N" (Amazon S3
// API reference, "Checking object integrity").
TEST(S3Store, PutsALargeObjectInParts) {
  const RandomFile file(2 * kPart_bytes + 5);
  const auto store = opened("large");
  const auto put = store->put(file.sha256, file.path);
  ASSERT_TRUE(put) << put.error().what;
  core::Bytes digests;
  for (std::size_t at = 0; at < file.bytes.size(); at += kPart_bytes) {
    const auto part =
        core::ByteView(file.bytes).subspan(at).first(std::min(kPart_bytes, file.bytes.size() - at));
    const auto digest = core::hex_decoded(md5(part)).value();
    digests.insert(digests.end(), digest.begin(), digest.end());
  }
  EXPECT_EQ(s3_server().etag(key_of("large", file.sha256)), md5(digests) + "-3");
  EXPECT_EQ(store->size_of(file.sha256).value(), file.bytes.size());
  EXPECT_EQ(sha256_of(*store, file.sha256), file.sha256);
  const auto across = core::ByteView(file.bytes).subspan(kPart_bytes - 3, 6);
  EXPECT_EQ(text_of(*store, file.sha256, kPart_bytes - 3, 6), core::text_of(across));
}

TEST(S3Store, APartsSizeExactlyAndAnEmptyFileArePutToo) {
  const auto store = opened("edges");
  for (const std::size_t size : {kPart_bytes, std::size_t{0}}) {
    const RandomFile file(size);
    const auto put = store->put(file.sha256, file.path);
    ASSERT_TRUE(put) << put.error().what;
    EXPECT_EQ(store->size_of(file.sha256).value(), size);
    EXPECT_EQ(sha256_of(*store, file.sha256), file.sha256);
  }
}

TEST(S3Store, AFileThatIsNotWhatItIsSaidToBeIsNotTakenAndLeavesNothing) {
  const auto store = opened("wrong");
  const RandomFile small(10), large(kPart_bytes + 1);
  for (const RandomFile* file : {&small, &large}) {
    EXPECT_EQ(store->put(kAbc, file->path).error().code, core::Errc::corrupt);
    EXPECT_EQ(store->size_of(kAbc).value(), std::nullopt);
  }
  EXPECT_EQ(s3_server().unfinished_uploads(), 0);
}

TEST(S3Store, SaysWhatIsWrongWithCredentialsAndBucketAndNeverTheSecret) {
  const auto right = [] { return opened("x"), S3Credentials::find().value(); }();
  const fs::path file = abc_file();
  struct Case {
    std::string address;
    S3Credentials credentials;
    const char* words;
  };
  const std::string address = s3_server().address("refused");
  for (const Case& c :
       {Case{address, {right.key_id, "not-the-secret-1", ""}, "SignatureDoesNotMatch"},
        Case{address, {"NOBODY", right.secret, ""}, "InvalidAccessKeyId"},
        Case{s3_server().address_without_bucket(), right, "create the bucket"}}) {
    const auto put = opened(c.address, c.credentials)->put(kAbc, file);
    ASSERT_FALSE(put);
    EXPECT_EQ(put.error().code, core::Errc::unavailable) << "a station keeps its trial";
    EXPECT_THAT(put.error().what, HasSubstr(c.words));
    EXPECT_THAT(put.error().what, Not(HasSubstr(c.credentials.secret)));
    EXPECT_THAT(put.error().what, Not(HasSubstr("\n")));
  }
}

TEST(S3Store, AGatewayKilledInAPutLeavesTheObjectWholeOrAbsent) {
  const RandomFile file(3 * kPart_bytes);
  const auto begun = std::chrono::steady_clock::now();
  ASSERT_TRUE(opened("not-killed")->put(file.sha256, file.path));
  const std::chrono::duration<double> undisturbed = std::chrono::steady_clock::now() - begun;
  std::mt19937 random(20261127);
  int refused = 0;
  for (int kill = 0; kill < 6; ++kill) {
    const auto store = opened(fmt::format("killed-{}", kill));
    const auto within = undisturbed * std::uniform_real_distribution<double>(0.0, 1.2)(random);
    std::thread killer([&] {
      std::this_thread::sleep_for(within);
      s3_server().kill_gateway();
    });
    const auto put = store->put(file.sha256, file.path);
    killer.join();
    if (!put) {
      ++refused;
      EXPECT_EQ(put.error().code, core::Errc::unavailable) << put.error().what;
    }
    s3_server().start();
    const auto size = store->size_of(file.sha256);
    ASSERT_TRUE(size) << size.error().what;
    if (put) {
      EXPECT_EQ(*size, file.bytes.size()) << "acknowledged, and not there";
    }
    if (*size) {
      EXPECT_EQ(sha256_of(*store, file.sha256), file.sha256);
    }
    EXPECT_TRUE(store->put(file.sha256, file.path)) << "it goes on when the gateway is back";
    EXPECT_EQ(store->size_of(file.sha256).value(), file.bytes.size());
  }
  std::printf("6 kills, %d puts that were refused\n", refused);
  EXPECT_GT(refused, 0) << "no kill met a put: the test shows nothing";
}

TEST(S3Store, AGatewayThatIsSilentIsNotWaitedForLongerThanAHalfMinute) {
  const auto store = opened("silent");
  ::kill(s3_server().gateway(), SIGSTOP);
  const auto begun = std::chrono::steady_clock::now();
  const auto size = store->size_of(kAbc);
  const auto waited = std::chrono::steady_clock::now() - begun;
  ::kill(s3_server().gateway(), SIGCONT);
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, core::Errc::unavailable);
  EXPECT_LT(waited, std::chrono::seconds(45));
  EXPECT_TRUE(store->size_of(kAbc));
}

// A trial's file handed to two folders, as two servers have them, each the cache of one bucket.
TEST(S3Store, AnObjectPutThroughOneFolderIsFetchedThroughAnother) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("tractus-" + core::new_id());
  fs::create_directories(folder / "a");
  fs::create_directories(folder / "b");
  const auto one = std::move(Objects::open(folder / "a", opened("shared")).value());
  const auto other = std::move(Objects::open(folder / "b", opened("shared")).value());
  ASSERT_EQ(one.put(core::bytes_of("abc")).value(), kAbc);
  const auto fetched = other.file(kAbc);
  ASSERT_TRUE(fetched) << fetched.error().what;
  EXPECT_EQ(core::text_of(core::read_file(*fetched).value()), "abc");
  EXPECT_EQ(other.kept_sha256(kAbc).value(), kAbc);
  ASSERT_TRUE(one.remove(kAbc));
  EXPECT_EQ(other.size_of(kAbc).value(), std::nullopt);
  fs::remove_all(folder);
}

/// A peer that breaks off in the middle of its first answer, and gives the rest to whoever asks for
/// it by its range.
class BreakingPeer {
 public:
  BreakingPeer() : listening_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    EXPECT_EQ(::bind(listening_, reinterpret_cast<sockaddr*>(&at), size), 0);
    EXPECT_EQ(::listen(listening_, 4), 0);
    EXPECT_EQ(::getsockname(listening_, reinterpret_cast<sockaddr*>(&at), &size), 0);
    port = ::ntohs(at.sin_port);
    thread_ = std::thread([this] {
      answer("HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\n0123");
      answer(
          "HTTP/1.1 206 Partial Content\r\nContent-Length: 6\r\nContent-Range: bytes 4-9/10\r\n"
          "\r\n456789");
    });
  }
  ~BreakingPeer() {
    thread_.join();
    ::close(listening_);
  }
  BreakingPeer(const BreakingPeer&) = delete;
  BreakingPeer& operator=(const BreakingPeer&) = delete;
  int port = 0;
  std::vector<std::string> asked;

 private:
  void answer(std::string_view text) {
    const int fd = ::accept(listening_, nullptr, nullptr);
    std::string head(8192, '\0');
    const ssize_t size = ::recv(fd, head.data(), head.size(), 0);
    asked.push_back(head.substr(0, static_cast<std::size_t>(std::max<ssize_t>(size, 0))));
    EXPECT_EQ(::send(fd, text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
    ::close(fd);
  }
  int listening_;
  std::thread thread_;
};

TEST(S3Store, AReadThatBreaksOffGoesOnWhereItWas) {
  BreakingPeer peer;
  const auto store =
      opened(fmt::format("http://127.0.0.1:{}/bucket", peer.port), {"KEY", "secret", ""});
  EXPECT_EQ(text_of(*store, kAbc), "0123456789");
  ASSERT_EQ(peer.asked.size(), 2u);
  EXPECT_THAT(peer.asked[0], Not(HasSubstr("Range:")));
  EXPECT_THAT(peer.asked[1], HasSubstr("Range: bytes=4-\r\n"));
}

}  // namespace
}  // namespace store
}  // namespace tractus
