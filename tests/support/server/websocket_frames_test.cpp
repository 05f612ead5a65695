#include "tests/support/server/websocket_frames.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace world {
namespace {

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) out.push_back(static_cast<char>(value));
  return out;
}

constexpr std::array<std::byte, 4> kMask{std::byte{0x37}, std::byte{0xfa}, std::byte{0x21},
                                         std::byte{0x3d}};

std::string text_of(const core::Result<std::optional<WebSocketEvent>>& event) {
  if (!event) return "error: " + event.error().what;
  return *event ? (*event)->payload : "nothing";
}

TEST(WebSocketFrame, IsThatOfTheStandardsExample) {
  // RFC 6455 section 5.7: "A single-frame masked text message", which contains "Hello".
  EXPECT_EQ(websocket_frame(Opcode::text, "Hello", kMask),
            bytes({0x81, 0x85, 0x37, 0xfa, 0x21, 0x3d, 0x7f, 0x9f, 0x4d, 0x51, 0x58}));
}

TEST(WebSocketFrame, SaysItsLengthInTheShortestOfThreeWays) {
  // Section 5.2: up to 125 in the byte itself, up to 65535 in two more, then in eight.
  EXPECT_EQ(websocket_frame(Opcode::text, std::string(125, 'x'), kMask).size(), 2u + 4 + 125);
  EXPECT_EQ(websocket_frame(Opcode::text, std::string(126, 'x'), kMask).substr(0, 4),
            bytes({0x81, 0xFE, 0x00, 0x7E}));
  EXPECT_EQ(websocket_frame(Opcode::text, std::string(65536, 'x'), kMask).substr(0, 10),
            bytes({0x81, 0xFF, 0, 0, 0, 0, 0, 1, 0, 0}));
}

TEST(WebSocketReader, GivesMessagesHoweverTheirBytesAreCut) {
  // Section 5.7: unmasked "Hello" in one frame, then in two fragments, then a ping of "Hello".
  const std::string all = bytes({0x81, 0x05, 'H', 'e', 'l', 'l', 'o', 0x01, 0x03, 'H', 'e', 'l',
                                 0x89, 0x05, 'H', 'e', 'l', 'l', 'o', 0x80, 0x02, 'l', 'o'});
  for (std::size_t piece = 1; piece <= all.size(); ++piece) {
    WebSocketReader reader;
    std::vector<std::pair<Opcode, std::string>> got;
    for (std::size_t at = 0; at < all.size(); at += piece) {
      reader.add(std::string_view(all).substr(at, piece));
      for (auto event = reader.next(); event && *event; event = reader.next())
        got.emplace_back((*event)->opcode, (*event)->payload);
    }
    EXPECT_EQ(got, (std::vector<std::pair<Opcode, std::string>>{
                       {Opcode::text, "Hello"}, {Opcode::ping, "Hello"}, {Opcode::text, "Hello"}}));
  }
}

TEST(WebSocketReader, RefusesWhatAServerMayNotSend) {
  for (const std::string& rubbish :
       {bytes({0x81, 0x85, 1, 2, 3, 4, 0, 0, 0, 0, 0}),  // masked
        bytes({0xC1, 0x01, 'x'}),                        // an extension's bit
        bytes({0x80, 0x01, 'x'}),                        // goes on with nothing
        bytes({0x09, 0x01, 'x'}),                        // a ping in pieces
        bytes({0x89, 0x7E, 0x00, 0x7E}),                 // a ping of 126 bytes
        bytes({0x82, 0x01, 'x'}),                        // binary
        bytes({0x01, 0x01, 'x', 0x81, 0x01, 'y'})}) {    // begins anew within
    WebSocketReader reader;
    reader.add(rubbish);
    EXPECT_FALSE(reader.next()) << text_of(reader.next());
  }
}

TEST(WebSocketReader, DoesNotWaitForWhatIsTooLong) {
  WebSocketReader reader;
  reader.add(bytes({0x81, 0x7F, 0x7F, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}));
  const auto event = reader.next();
  ASSERT_FALSE(event);
  EXPECT_EQ(event.error().code, core::Errc::too_large);
}

}  // namespace
}  // namespace world
}  // namespace tractus
