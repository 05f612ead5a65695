#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <fstream>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/named.hpp"
#include "core/progress.hpp"
#include "core/signing.hpp"
#include "core/words.hpp"

namespace tractus {
namespace core {
namespace {

TEST(Crc32c, MatchesTheCheckValueOfRfc3720) {
  EXPECT_EQ(crc32c(bytes_of("123456789")),
            0xE3069283u);  // RFC 3720 B.4 and the CRC catalogue's check
  EXPECT_EQ(crc32c(bytes_of("56789"), crc32c(bytes_of("1234"))), 0xE3069283u);
}

TEST(Sha256, MatchesFips180) {
  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256(bytes_of("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Id, IsNewAndRecognised) {
  const auto a = new_id(), b = new_id();
  EXPECT_TRUE(is_id(a));
  EXPECT_NE(a, b);
  EXPECT_FALSE(is_id("../../etc/passwd"));
}

/// RFC 4648 section 10: the texts of f, fo, … in each form.
TEST(Text, OfBytesIsThatOfTheStandard) {
  struct Row {
    const char *plain, *padded, *url, *hex;
  };
  for (const Row& row :
       {Row{"", "", "", ""}, Row{"f", "Zg==", "Zg", "66"}, Row{"fo", "Zm8=", "Zm8", "666f"},
        Row{"foo", "Zm9v", "Zm9v", "666f6f"}, Row{"foob", "Zm9vYg==", "Zm9vYg", "666f6f62"},
        Row{"foobar", "Zm9vYmFy", "Zm9vYmFy", "666f6f626172"},
        Row{"\xfb\xff", "+/8=", "-_8", "fbff"}}) {
    const auto bytes = bytes_of(row.plain);
    const Bytes held(bytes.begin(), bytes.end());
    EXPECT_EQ(base64(bytes), row.padded);
    EXPECT_EQ(base64url(bytes), row.url);
    EXPECT_EQ(hex(bytes), row.hex);
    EXPECT_EQ(base64_decoded(row.padded), held);
    EXPECT_EQ(base64url_decoded(row.url), held);
    EXPECT_EQ(hex_decoded(row.hex), held);
  }
  EXPECT_EQ(hex_decoded("FBff"), hex_decoded("fbff"));
}

/// Digits left over or missing, another alphabet, blanks, and bits that another text would have 0.
TEST(Text, ThatIsNotOfBytesIsRefused) {
  for (const char* wrong : {"Z", "Zg==", "Zg=", "Z g", "+/8", "Zh", "Zg\n", "Zm9vY", "="})
    EXPECT_FALSE(base64url_decoded(wrong)) << wrong;
  for (const char* wrong :
       {"Z", "Zg", "Zg=", "Zg===", "Zh==", "-_8=", "Zg==Zg==", "Zg==\n", "===="})
    EXPECT_FALSE(base64_decoded(wrong)) << wrong;
  for (const char* wrong : {"6", "66 6f", "6g", "66\n", "0x66", "66:6f", "666"})
    EXPECT_FALSE(hex_decoded(wrong)) << wrong;
  EXPECT_FALSE(base64_decoded(std::string_view("Zg\0=", 4)));
}

TEST(Signature, HoldsForTheMessageAndForNothingElse) {
  const auto key = KeyPair::generate();
  const auto signature = sign(bytes_of("case"), key);
  EXPECT_TRUE(verify(bytes_of("case"), signature, key.public_hex));
  EXPECT_FALSE(verify(bytes_of("cast"), signature, key.public_hex));
  EXPECT_FALSE(verify(bytes_of("case"), signature, KeyPair::generate().public_hex));
  EXPECT_FALSE(verify(bytes_of("case"), "zz", key.public_hex));
}

enum class Light { on, off };
constexpr auto words(Light) {
  return std::to_array<Word<Light>>({{Light::on, "on"}, {Light::off, "dark"}});
}

TEST(Named, ReadsAndWritesTheWordsOfItsTable) {
  EXPECT_EQ(name(Light::off), "dark");
  EXPECT_EQ(from_name<Light>("dark"), Light::off);
  EXPECT_FALSE(from_name<Light>("off"));
  EXPECT_EQ(names<Light>(), (std::vector<std::string>{"on", "dark"}));
}

enum class Gap { first, second };
constexpr auto words(Gap) { return std::to_array<Word<Gap>>({{Gap::first, "first"}}); }

TEST(Named, ATableWithoutAValueIsNoticedByTheCompiler) {
  static_assert(is_whole<Light>());
  static_assert(!is_whole<Gap>());
}

TEST(Named, AnUnknownWordInJsonIsAnErrorWithThoseAllowed) {
  const Json json{{"light", "dim"}};
  Fields fields(json, "room: ");
  fields.word<Light>("light");
  const auto done = fields.done();
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().what, "room: /light: 'dim' is none of on, dark");
}

TEST(Named, AWordThatIsMissingIsTheGivenOneOrAnError) {
  const Json json = Json::object();
  Fields lenient(json, "room: "), strict(json, "room: ");
  EXPECT_EQ(lenient.word_or("light", Light::off), Light::off);
  EXPECT_TRUE(lenient.done());
  strict.word<Light>("light");
  EXPECT_EQ(strict.done().error().what, "room: /light: is missing");
}

class FileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("tractus_core_" + std::to_string(::getpid()) + "_" + new_id());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(FileTest, WritesWholeAndLeavesNothingBeside) {
  ASSERT_TRUE(write_file(folder_ / "a", bytes_of("one")));
  ASSERT_TRUE(write_file(folder_ / "a", bytes_of("two")));
  EXPECT_EQ(text_of(*read_file(folder_ / "a")), "two");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST(Progress, AsksToStopOnceASignalWasCaught) {
  EXPECT_TRUE(terminal_progress("x")(0.5));
  const auto stopped = [] {
    stop_on_signals();
    std::raise(SIGINT);
    return !terminal_progress("x")(0.5);
  };
  EXPECT_EXIT(std::_Exit(stopped() ? 7 : 1), testing::ExitedWithCode(7), "");
}

TEST_F(FileTest, LeavesWhatIsNoRegularFileInItsPlace) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto written = write_file(pipe, bytes_of("one"));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::conflict);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_), {}), 1);
}

TEST_F(FileTest, RefusesAFileOverTheLimitBeforeReadingIt) {
  ASSERT_TRUE(write_file(folder_ / "a", bytes_of("12345")));
  const auto read = read_file(folder_ / "a", 4);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, Errc::too_large);
}

TEST_F(FileTest, ScratchFolderVanishesUnlessKept) {
  {
    auto scratch = ScratchFolder::make(folder_ / "out");
    ASSERT_TRUE(scratch);
    ASSERT_TRUE(write_file(scratch->path() / "x", bytes_of("x")));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
  auto scratch = ScratchFolder::make(folder_ / "out");
  ASSERT_TRUE(scratch);
  ASSERT_TRUE(scratch->keep_as(folder_ / "out"));
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "out"));
}

TEST(Fields, NamesTheFieldThatIsWrong) {
  const auto json = parse_json(R"({"a": 1, "b": "x", "typo": 3})", "t.json");
  ASSERT_TRUE(json);
  Fields range(*json, "t.json: ");
  range.number("a", 2, 3);
  EXPECT_EQ(range.done().error().what, "t.json: /a: 1 is outside 2 … 3");
  Fields unknown(*json, "t.json: ");
  EXPECT_EQ(unknown.number("a", 0, 3), 1.0);
  EXPECT_EQ(unknown.text("b"), "x");
  EXPECT_EQ(unknown.done().error().what, "t.json: /typo: this field is not known");
}

TEST(Json, SaysWhereTheTextBreaks) {
  const auto json = parse_json("{\"a\": }", "t.json");
  ASSERT_FALSE(json);
  EXPECT_THAT(json.error().what, testing::HasSubstr("line 1, column 7"));
}

std::string refusal(const std::string& text, const JsonLimits& limits = kForeignJson) {
  const auto json = parse_json(text, "t", limits);
  return json ? "" : json.error().what;
}

std::string nested(std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); }

TEST(Json, IsNestedAtMost32Levels) {
  EXPECT_EQ(refusal(nested(32)), "");
  EXPECT_THAT(refusal(nested(33)), testing::HasSubstr("nested deeper than 32 levels"));
  EXPECT_THAT(refusal(nested(1'000'000)), testing::HasSubstr("nested deeper than 32 levels"));
  std::string objects;
  for (int i = 0; i < 33; ++i) objects += "{\"a\":";
  EXPECT_THAT(refusal(objects), testing::HasSubstr("nested deeper than 32 levels"));
  EXPECT_EQ(refusal("[" + nested(32) + "]", kStoredJson), "") << "stored within one of our own";
  EXPECT_EQ(refusal("[\"" + std::string(100, '[') + "\"]"), "")
      << "brackets in a text nest nothing";
  EXPECT_TRUE(stored_json(nested(65)).is_null());
}

TEST(Json, IsBoundedInWidth) {
  std::string numbers = "[0";
  for (int i = 0; i < 2'000'000; ++i) numbers += ",0";
  EXPECT_THAT(refusal(numbers + "]"), testing::HasSubstr("more than 2000000 values"));
  const auto object = [](int members) {
    std::string out = "{";
    for (int i = 0; i < members; ++i) out += (i ? ",\"" : "\"") + std::to_string(i) + "\":0";
    return out + "}";
  };
  EXPECT_EQ(refusal(object(20'000)), "");
  EXPECT_THAT(refusal(object(20'001)), testing::HasSubstr("an object of more than 20000 members"));
}

TEST(Json, NamesEveryMemberOnce) {
  EXPECT_THAT(refusal(R"([{"a": 1, "b": 2, "a": 3}])"),
              testing::HasSubstr("the name \"a\" stands twice"));
  EXPECT_EQ(refusal(R"([{"a": 1}, {"a": {"a": 2}}])"), "");
}

TEST(Json, HoldsNumbersThatADoubleHolds) {
  for (const char* text : {"1e999", "-1e999", "[1e309]"})
    EXPECT_THAT(refusal(text), testing::HasSubstr("number overflow")) << text;
  EXPECT_THAT(refusal("0." + std::string(63, '1')),
              testing::HasSubstr("a number of 65 characters, at most 64"));
  EXPECT_EQ(refusal("0." + std::string(62, '1')), "");
  EXPECT_LT(refusal("1" + std::string(1'000'000, '0')).size(), 400u) << "one bearable line";
  EXPECT_EQ(*parse_json("-9223372036854775808", "t"), INT64_MIN);
  EXPECT_EQ(*parse_json("18446744073709551615", "t"), UINT64_MAX);
}

TEST(Json, IsUtf8) {
  for (const char* bytes : {"\xff", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82"})
    EXPECT_THAT(refusal("\"" + std::string(bytes) + "\""), testing::HasSubstr("UTF-8"));
  EXPECT_EQ(*parse_json("\"\u00e9\"", "t"), "\u00e9");
}

TEST(Json, KeepsValuesAndTheirOrder) {
  const std::string text = R"({"z":[1,-2,2.5,true,null,"x\n"],"a":{"b":{}},"m":[]})";
  EXPECT_EQ(parse_json(text, "t")->dump(), text);
}

TEST(Clock, FormatsUtc) {
  EXPECT_EQ(utc_text(1'700'000'000'123'456), "2023-11-14T22:13:20.123456Z");
}

TEST(Words, OneLineKeepsCharactersWholeAndNothingThatMovesACursor) {
  EXPECT_EQ(one_line("a\nb\x1b[2Jc\x7f"), "a?b?[2Jc?");
  EXPECT_EQ(one_line("ab\u00e9\u00e9", 6), "ab\u00e9\u00e9");
  EXPECT_EQ(one_line("ab\u00e9\u00e9", 5), "ab\u00e9\u2026");  // the cut falls within the second e
  EXPECT_EQ(one_line("", 0), "");
}

TEST(Words, AreCountedByCharactersNotByBytes) {
  EXPECT_EQ(characters(""), 0u);
  EXPECT_EQ(characters("N\u00b7m"), 3u);
  EXPECT_EQ(characters("\u2265 \U0001F980"), 3u);
}

}  // namespace
}  // namespace core
}  // namespace tractus
