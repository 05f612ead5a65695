#include "core/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace tractus {
namespace core {
namespace {
namespace fs = std::filesystem;
using Records = std::vector<std::vector<std::string>>;
using testing::HasSubstr;

struct Read {
  Records records;
  std::vector<std::size_t> lines;
  std::string error;
};

Read all_of(CsvReader reader) {
  Read out;
  std::vector<std::string_view> cells;
  for (;;) {
    const auto more = reader.next(cells);
    if (!more) return out.error = more.error().what, out;
    if (!*more) return out;
    out.records.emplace_back(cells.begin(), cells.end());
    out.lines.push_back(reader.line());
  }
}

/// From memory and from a file: the same.
Read read(std::string text, char separator = ',', std::size_t most = 65'536) {
  const fs::path path =
      fs::temp_directory_path() / ("tractus_csv_" + std::to_string(::getpid()) + ".csv");
  std::ofstream(path, std::ios::binary) << text;
  auto reader = CsvReader::open(path, most, separator);
  fs::remove(path);
  EXPECT_TRUE(reader);
  Read from_file = all_of(std::move(*reader));
  if (text.size() <= most) {
    const Read from_memory = all_of({text, path.string(), separator});
    EXPECT_EQ(from_memory.records, from_file.records);
    EXPECT_EQ(from_memory.lines, from_file.lines);
    EXPECT_EQ(from_memory.error, from_file.error);
  }
  return from_file;
}

/// The examples of RFC 4180 section 2, in its order.
TEST(Csv, ReadsTheStandardsExamples) {
  const Records two{{"aaa", "bbb", "ccc"}, {"zzz", "yyy", "xxx"}};
  EXPECT_EQ(read("aaa,bbb,ccc\r\nzzz,yyy,xxx\r\n").records, two);
  EXPECT_EQ(read("aaa,bbb,ccc\r\nzzz,yyy,xxx").records, two);
  EXPECT_EQ(read("field_name,field_name,field_name\r\naaa,bbb,ccc\r\nzzz,yyy,xxx\r\n").records[0],
            (std::vector<std::string>{"field_name", "field_name", "field_name"}));
  EXPECT_EQ(read("\"aaa\",\"bbb\",\"ccc\"\r\nzzz,yyy,xxx").records, two);
  EXPECT_EQ(read("\"aaa\",\"b\r\nbb\",\"ccc\"\r\nzzz,yyy,xxx").records,
            (Records{{"aaa", "b\r\nbb", "ccc"}, {"zzz", "yyy", "xxx"}}));
  EXPECT_EQ(read("\"aaa\",\"b\"\"bb\",\"ccc\"").records, (Records{{"aaa", "b\"bb", "ccc"}}));
}

TEST(Csv, CountsLinesNotRecords) {
  const auto seen = read("a,b\n\"1\n2\n\n3\",x\n\n4,\"y\"");
  EXPECT_EQ(seen.records, (Records{{"a", "b"}, {"1\n2\n\n3", "x"}, {""}, {"4", "y"}}));
  EXPECT_EQ(seen.lines, (std::vector<std::size_t>{1, 2, 6, 7}));
  EXPECT_EQ(read("").records, Records{});
  EXPECT_EQ(read("\n").records, Records{{""}});
}

TEST(Csv, TakesWhatProgramsMakeOfIt) {
  EXPECT_EQ(read("\xef\xbb\xbf\"a\",b\n1,2\n").records, (Records{{"a", "b"}, {"1", "2"}}));
  EXPECT_EQ(read("\xef\xbb\xbf").records, Records{});
  EXPECT_EQ(read(" a ,\t\"b \" , \n,,\n").records, (Records{{"a", "b ", ""}, {"", "", ""}}))
      << "blanks round cells";
  EXPECT_EQ(read("a\"b,5\" x\n").records, (Records{{"a\"b", "5\" x"}}));
  EXPECT_EQ(read("\"\",\"\"\"\",\"\"\"a\"\"\"\n").records, (Records{{"", "\"", "\"a\""}}));
  EXPECT_EQ(read("a b\t\"c\td\"\t\n", '\t').records, (Records{{"a b", "c\td", ""}}));
  EXPECT_EQ(read("a;b\r\n").records, (Records{{"a;b"}}));
}

TEST(Csv, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(read("a,b\n1,\"2\n3,4\n").error, HasSubstr(".csv:2: a quote stays open"));
  EXPECT_THAT(read("\"").error, HasSubstr(".csv:1: a quote stays open"));
  EXPECT_THAT(read("a\n\"b\" c,d\n").error, HasSubstr(".csv:2: text follows a quoted cell"));
  EXPECT_THAT(read("a\n" + std::string(101, 'x') + "\n", ',', 100).error,
              HasSubstr(".csv:2: the line is longer than 100 bytes"));
  EXPECT_EQ(read("a\n" + std::string(100, 'x') + "\r\nb", ',', 100).records.size(), 3u);
  EXPECT_THAT(read("a\n\"" + std::string(1 << 20, '\n')).error,
              HasSubstr(".csv:2: the line is longer"))
      << "a cell without end, in bounded memory";
}

TEST(Csv, RecordsAreWholeHoweverTheBufferCutsThem) {
  std::string text;
  Records expected;
  for (int i = 0; i < 30'000; ++i) {  // several buffers of 256 KiB
    text +=
        std::to_string(i) + ",\"a \"\"b\"\"\r\n" + std::string(std::size_t(i % 7), 'x') + "\"\r\n";
    expected.push_back({std::to_string(i), "a \"b\"\r\n" + std::string(std::size_t(i % 7), 'x')});
  }
  const auto seen = read(text);
  EXPECT_EQ(seen.records, expected);
  EXPECT_EQ(seen.lines.back(), 2 * 30'000u - 1);
}

TEST(Csv, WhatIsWrittenIsReadBack) {
  EXPECT_EQ(csv_cell("plain text"), "plain text");
  EXPECT_EQ(csv_cell("b\"bb"), "\"b\"\"bb\"");  // RFC 4180 section 2, rule 7
  const std::vector<std::string> texts{"",        " a",   "a ",   "a,b",  "\"",
                                       "\"\"",    "a\"b", "a\nb", "\r\n", "a",
                                       "\"a\",b", "'",    ",",    "\t",   "\u00e9"};
  std::string line;
  for (const auto& text : texts) line += csv_cell(text) + ",";
  auto expected = texts;
  expected.emplace_back();
  EXPECT_EQ(read(line + "\n").records, Records{expected});
}

TEST(Csv, APersonsTextIsNoFormula) {
  EXPECT_EQ(csv_person_cell("=1+1"), "'=1+1");
  EXPECT_EQ(csv_person_cell("@a,b"), "\"'@a,b\"");
  EXPECT_EQ(csv_person_cell("a=b"), "a=b");
  EXPECT_EQ(csv_person_cell(""), "");
}

}  // namespace
}  // namespace core
}  // namespace tractus
