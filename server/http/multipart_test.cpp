/// Bodies of several parts, whole and in pieces.
#include "server/http/multipart.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tractus {
namespace http {
namespace {

struct Part {
  std::string type, bytes;
  bool ended = false;
  bool operator==(const Part&) const = default;
};

/// The parts of a body that comes in pieces of this size, and the first error's words.
struct Parts {
  std::vector<Part> parts;
  std::string error;
};
Parts parts_of(std::string_view body, std::size_t piece, const char* boundary = "b") {
  Parts out;
  Multipart reader(boundary, "the peer",
                   {.begin =
                        [&](const std::string& type) {
                          out.parts.push_back({type, ""});
                          return core::Result<void>();
                        },
                    .bytes =
                        [&](std::string_view bytes) {
                          out.parts.back().bytes += bytes;
                          return core::Result<void>();
                        },
                    .end =
                        [&] {
                          out.parts.back().ended = true;
                          return core::Result<void>();
                        }});
  for (std::size_t at = 0; at < body.size(); at += piece)
    if (const auto taken = reader.take(body.substr(at, piece)); !taken) {
      out.error = taken.error().what;
      return out;
    }
  if (const auto whole = reader.finish(); !whole) out.error = whole.error().what;
  return out;
}

TEST(Multipart, IsTheSameInPiecesOfAnySize) {
  // RFC 2046, section 5.1.1: a preamble, blanks behind a boundary, a part without headers, what
  // looks like a boundary and is none, an epilogue.
  const std::string body =
      "preamble\r\n--b\r\nContent-Type: Application/DICOM; x=1\r\n\r\none\r\n--\r\n-b\r\n--b "
      "\t\r\n\r\n"
      "two\r\n\r\n--b\r\nX: y\r\n\r\n\r\n--b--\r\nepilogue\r\n--b\r\n";
  const std::vector<Part> expected{
      {"application/dicom", "one\r\n--\r\n-b", true}, {"", "two\r\n", true}, {"", "", true}};
  for (std::size_t piece = 1; piece <= body.size(); ++piece) {
    const Parts read = parts_of(body, piece);
    EXPECT_EQ(read.error, "") << piece;
    EXPECT_EQ(read.parts, expected) << piece;
  }
}

TEST(Multipart, MayBeginWithItsBoundary) {
  EXPECT_EQ(parts_of("--b\r\n\r\nx\r\n--b--", 3).parts, (std::vector<Part>{{"", "x", true}}));
}

TEST(Multipart, IsRefusedWhenItIsNotWhole) {
  for (const char* body : {"", "hello", "--another\r\n\r\nx\r\n--another--"})
    EXPECT_NE(parts_of(body, 4).error.find("no part with the boundary"), std::string::npos) << body;
  for (const char* body :
       {"--b", "--b\r\n", "--b\r\nX: y\r\n\r\n", "--b\r\n\r\nx", "--b\r\n\r\nx\r\n--b"})
    EXPECT_NE(parts_of(body, 4).error.find("ends before its last boundary"), std::string::npos)
        << body;
}

TEST(Multipart, HoldsNoHeadersWithoutEnd) {
  EXPECT_NE(parts_of("--b\r\nX: " + std::string(100'000, 'a'), 1000).error.find("have no end"),
            std::string::npos);
  EXPECT_NE(parts_of("--b" + std::string(100'000, ' '), 1000).error.find("does not end its line"),
            std::string::npos);
  EXPECT_NE(parts_of("--bc\r\n\r\nx\r\n--b--", 4).error.find("does not end its line"),
            std::string::npos);
}

TEST(MediaType, StatesItsBoundary) {
  const std::string whole = "Multipart/Related; type=\"application/dicom\";\tBoundary=\"a;b c\" ";
  EXPECT_EQ(media_type_of(whole).type, "multipart/related");
  EXPECT_EQ(media_type_of(whole).boundary, "a;b c");
  EXPECT_EQ(media_type_of("multipart/related; boundary=x-1").boundary, "x-1");
  EXPECT_EQ(media_type_of("text/html").boundary, "");
  EXPECT_EQ(media_type_of("").type, "");
}

}  // namespace
}  // namespace http
}  // namespace tractus
