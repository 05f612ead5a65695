#include "assessment/table.hpp"

#include <gtest/gtest.h>

#include "assessment/snapshot.hpp"

namespace tractus {
namespace assessment {
namespace {

core::Result<Table> read_table_of(const std::string& text) {
  const auto bytes = core::bytes_of(text);
  return Table::parse({bytes.begin(), bytes.end()}, "t.csv", {}, Missing::keep);
}

TEST(Table, HoldsQuotedCellsAsTheyWereMeant) {
  const auto table = read_table_of(
      "\xef\xbb\xbfwho,said,n\r\n"
      "a,\"one, \"\"two\"\"\",1\r\n"
      "b,\"line\r\nbreak\",2\r\n");
  ASSERT_TRUE(table) << table.error().what;
  EXPECT_EQ(table->columns(), (std::vector<std::string>{"who", "said", "n"}));
  EXPECT_EQ(table->texts("said"), (std::vector<std::string_view>{"one, \"two\"", "line\r\nbreak"}));
  EXPECT_TRUE(table->is_numeric("n"));
  EXPECT_EQ(table->line(1), 3u);

  const auto again = read_table_of(marked(*table, {"", "not \"there\""}));
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->texts("said"), table->texts("said"));
  EXPECT_EQ(again->texts("excluded_because")[1], "not \"there\"");
}

TEST(Table, SaysInWhichLineItStumbled) {
  EXPECT_EQ(read_table_of("a,b\n\"1\n\",2\n3\n").error().what,
            "t.csv:4: 1 cells, the header has 2");
  EXPECT_EQ(read_table_of("a,b\n1,\"2\n3,4\n").error().what, "t.csv:2: a quote stays open");
  EXPECT_EQ(read_table_of("\n1\n").error().what, "t.csv:1: the header line is empty");
  EXPECT_EQ(read_table_of("").error().what, "t.csv:1: the header line is empty");
  EXPECT_EQ(read_table_of(std::string("a,\x01\n1,2\n")).error().what,
            "t.csv:1: this is no text file");
}

TEST(Table, NamesTheColumnsThatAreThereWhenOneIsNot) {
  std::string header = "c0";
  for (int i = 1; i < 64; ++i) header += ",c" + std::to_string(i);
  std::string row = "0";
  for (int i = 1; i < 64; ++i) row += ",0";
  const std::string text = header + "\n" + row + "\n";
  const auto bytes = core::bytes_of(text);
  const std::vector<std::string> wanted{"operation_time"};
  const auto table = Table::parse({bytes.begin(), bytes.end()}, "t.csv", wanted, Missing::keep);
  ASSERT_FALSE(table);
  EXPECT_NE(table.error().what.find("no column 'operation_time'; the columns are c0, c1, c2"),
            std::string::npos)
      << table.error().what;
  EXPECT_NE(table.error().what.find("c63"), std::string::npos) << table.error().what;
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
