#include "server/http/static_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "core/bytes.hpp"
#include "core/file.hpp"

namespace tractus {
namespace http {
namespace {
namespace fs = std::filesystem;

/// dist/ with a page, a hashed script and links; a secret beside it.
class Site : public ::testing::Test {
 protected:
  Site() {
    fs::create_directories(root_ / "dist" / "assets");
    write("secret.txt", "secret");
    write("dist/index.html", "page");
    write("dist/.hidden", "hidden");
    write("dist/assets/app-1a2b.js", "script");
    fs::create_symlink(root_ / "secret.txt", root_ / "dist" / "link.txt");
  }
  ~Site() override { fs::remove_all(root_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(root_ / name) << text;
  }
  Response get(const std::string& path, std::map<std::string, std::string> headers = {}) const {
    RequestHead head;
    head.method = "GET";
    head.path = path;
    head.headers = std::move(headers);
    return StaticFiles(root_ / "dist").answer(head);
  }
  static std::string text(const Response& response) {
    if (const auto* slice = std::get_if<FileSlice>(&response.body))
      return std::string(core::text_of(core::read_file(slice->path).value()));
    return std::get<std::string>(response.body);
  }
  const fs::path root_ = fs::path(::testing::TempDir()) / ("tractus-" + core::new_id());
};

TEST_F(Site, ServesItsFilesWithTheirTypes) {
  const Response script = get("/assets/app-1a2b.js");
  EXPECT_EQ(script.status, 200);
  EXPECT_EQ(text(script), "script");
  EXPECT_EQ(script.header("Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_NE(script.header("Cache-Control").find("immutable"), std::string::npos);
}

TEST_F(Site, APathOfTheApplicationIsItsPageAndIsNeverKeptUnasked) {
  for (const char* path : {"/", "/trials", "/trials/abc"}) {
    const Response page = get(path);
    EXPECT_EQ(text(page), "page") << path;
    EXPECT_EQ(page.header("Cache-Control"), "no-cache") << path;
  }
}

TEST_F(Site, AnUnchangedFileIsNotSentAgain) {
  const std::string tag(get("/").header("ETag"));
  EXPECT_EQ(get("/", {{"if-none-match", tag}}).status, 304);
  EXPECT_EQ(get("/", {{"if-none-match", "\"other\""}}).status, 200);
}

TEST_F(Site, ACompressedCopyIsSentToAClientThatReadsItsCoding) {
  write("dist/assets/app-1a2b.js.br", "brotli");
  write("dist/assets/app-1a2b.js.gz", "gzip");
  const std::string path = "/assets/app-1a2b.js";
  const auto sent_to = [&](const std::string& accepted) {
    return get(path, {{"accept-encoding", accepted}});
  };
  // Accept-Encoding and its weights: RFC 9110, section 12.5.3, with its examples.
  EXPECT_EQ(text(sent_to("gzip, deflate, br")), "brotli");
  EXPECT_EQ(sent_to("gzip, deflate, br").header("Content-Encoding"), "br");
  EXPECT_EQ(text(sent_to("compress;q=0.5, gzip;q=1.0")), "gzip");
  EXPECT_EQ(sent_to("gzip").header("Content-Encoding"), "gzip");
  EXPECT_EQ(text(sent_to("br;q=0, gzip ; q=0.001")), "gzip");
  for (const char* plain : {"", "identity", "gzip;q=0.0, brx", "*"}) {
    EXPECT_EQ(text(sent_to(plain)), "script") << plain;
    EXPECT_EQ(sent_to(plain).header("Content-Encoding"), "") << plain;
  }
  for (const char* any : {"", "br", "gzip"}) {
    EXPECT_EQ(sent_to(any).header("Content-Type"), "text/javascript; charset=utf-8") << any;
    EXPECT_EQ(sent_to(any).header("Vary"), "Accept-Encoding") << any;
  }
}

TEST_F(Site, EachCodingOfAFileHasAnEntityTagOfItsOwn) {
  write("dist/index.html.br", "page");  // the same bytes and perhaps the same time
  const std::string plain(get("/").header("ETag"));
  const std::string coded(get("/", {{"accept-encoding", "br"}}).header("ETag"));
  EXPECT_NE(plain, coded);
  const Response unchanged = get("/", {{"accept-encoding", "br"}, {"if-none-match", coded}});
  EXPECT_EQ(unchanged.status, 304);
  EXPECT_EQ(unchanged.header("Vary"), "Accept-Encoding");
  EXPECT_EQ(get("/", {{"if-none-match", coded}}).status, 200);
}

TEST_F(Site, ACopyThatLeadsOutOfTheFolderIsNotSent) {
  fs::create_symlink(root_ / "secret.txt", root_ / "dist" / "index.html.gz");
  EXPECT_EQ(text(get("/", {{"accept-encoding", "gzip"}})), "page");
}

TEST_F(Site, NothingOutsideTheFolderIsServed) {
  for (const char* path :
       {"/../secret.txt", "/assets/../../secret.txt", "/%2e%2e/secret.txt", "/..%2fsecret.txt",
        "/%2e%2e%2fsecret.txt", "/assets/..%5c..%5csecret.txt", "/.hidden", "/link.txt",
        "//etc/passwd.txt", "/%00.txt", "/missing.js", "/assets/"}) {
    const Response response = get(path);
    EXPECT_NE(text(response), "secret") << path;
    EXPECT_NE(text(response), "hidden") << path;
    EXPECT_TRUE(response.status == 404 || text(response) == "page") << path;
  }
}

TEST_F(Site, IsOnlyRead) {
  RequestHead head;
  head.method = "POST";
  head.path = "/index.html";
  EXPECT_EQ(StaticFiles(root_ / "dist").answer(head).status, 405);
}

}  // namespace
}  // namespace http
}  // namespace tractus
