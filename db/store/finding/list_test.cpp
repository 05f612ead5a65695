/// Pages of lists, on both databases: complete, in order, and stable while rows come.
#include "db/store/finding/list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/finding/saved_views.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/trials/trials.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {
using Names = std::vector<std::string>;

class Lists : public test_support::BothDatabases {
 protected:
  /// Accounts "NNNN" with few different times and levels, so that sorting by those needs the key.
  void add(int from, int to) {
    const auto added = store_.write([&](Writing& tx) -> core::Result<void> {
      for (int i = from; i < to; ++i) {
        const std::string name = fmt::format("{:04}", i);
        TRY(add_account(tx,
                        {.id = "id-" + name,
                         .name = name,
                         .role = i % 3 == 0 ? Role::faculty : Role::trainee,
                         .password_hash = "h",
                         .level = fmt::format("PGY-{}", i % 5)},
                        i % 7));
      }
      return {};
    });
    ASSERT_TRUE(added) << added.error().what;
  }
  FoundKeys found(const ListRequest& request) {
    auto out = store_.read([&](Reading& tx) { return find_keys(tx, shape_, request); });
    EXPECT_TRUE(out) << out.error().what;
    return out ? std::move(*out) : FoundKeys();
  }
  /// By their ids, "id-NAME".
  static Names names_of(const FoundKeys& page) {
    Names out;
    for (const Value& key : page.keys) out.push_back(std::get<std::string>(key).substr(3));
    return out;
  }
  /// All pages from the first one on; the last page's cursor to the one before is put into `back`.
  Names walked(ListRequest request, std::string* back = nullptr) {
    Names out;
    do {
      const auto page = found(request);
      for (const std::string& name : names_of(page)) out.push_back(name);
      request.cursor = page.page.next;
      if (back) *back = page.page.previous;
    } while (!request.cursor.empty());
    return out;
  }
  std::string refusal(const ListRequest& request) {
    const auto out = store_.read([&](Reading& tx) { return find_accounts(tx, request); });
    return out ? "" : out.error().what;
  }

  ListShape shape_ = account_list();
  test_support::TestDatabase database_{GetParam()};
  Store store_ = database_.open();
};
TRACTUS_ON_BOTH_DATABASES(Lists);

/// 40 rows are gathered and sorted, of 300 an index is followed.
TEST_P(Lists, HaveEveryRowOnceInEveryOrderForwardsAndBackwards) {
  shape_.gathered = 50;
  add(0, 40);
  for (const int rows : {40, 300}) {
    if (rows == 300) add(40, 300);
    for (const ListOrder& order : account_list().orders)
      for (const bool descending : {false, true}) {
        SCOPED_TRACE(fmt::format("{} rows by {}, {}", rows, order.name, descending));
        ListRequest request{.sort = order.name, .descending = descending, .limit = rows / 8};
        std::string back;
        Names there = walked(request, &back);
        Names sorted = there;
        std::ranges::sort(sorted);
        EXPECT_EQ(std::ranges::unique(sorted).begin(), sorted.end()) << "none twice";
        ASSERT_EQ(there.size(), std::size_t(rows));
        there.resize(there.size() - (there.size() % std::size_t(rows / 8) == 0
                                         ? std::size_t(rows / 8)
                                         : there.size() % std::size_t(rows / 8)));
        Names again;
        for (request.cursor = back; !request.cursor.empty();) {
          const auto page = found(request);
          const Names on_page = names_of(page);
          again.insert(again.begin(), on_page.begin(), on_page.end());
          request.cursor = page.page.previous;
        }
        EXPECT_EQ(again, there);
      }
  }
}

TEST_P(Lists, AreInTheOrderAskedFor) {
  add(0, 6);  // levels 0 1 2 3 4 0, times 0 to 5
  EXPECT_EQ(walked({}), (Names{"0000", "0001", "0002", "0003", "0004", "0005"}));
  EXPECT_EQ(walked({.sort = "name", .descending = true}),
            (Names{"0005", "0004", "0003", "0002", "0001", "0000"}));
  EXPECT_EQ(walked({.sort = "level", .limit = 2}),
            (Names{"0000", "0005", "0001", "0002", "0003", "0004"}));
  EXPECT_EQ(names_of(found({.sort = "made", .limit = 1})), Names{"0005"}) << "newest first";
}

TEST_P(Lists, StayWholeWhileRowsComeBetweenThePages) {
  add(100, 140);
  Names seen;
  ListRequest request{.limit = 10};
  for (int page = 0; page < 4; ++page) {
    const auto now = found(request);
    for (const std::string& name : names_of(now)) seen.push_back(name);
    add(page * 10, page * 10 + 10);  // all of them sort before the page that comes next
    request.cursor = now.page.next;
  }
  Names expected;
  for (int i = 100; i < 140; ++i) expected.push_back(fmt::format("{:04}", i));
  EXPECT_EQ(seen, expected) << "none twice, none left out";
}

TEST_P(Lists, CountToAThousandAndSayThatThereAreMore) {
  add(0, 1000);
  EXPECT_EQ(found({}).page.total, 1000);
  EXPECT_FALSE(found({}).page.more_than_total);
  add(1000, 1001);
  EXPECT_EQ(found({}).page.total, 1000);
  EXPECT_TRUE(found({}).page.more_than_total);
  EXPECT_EQ(found({.filters = {{"role", "faculty"}}}).page.total, 334);  // 0, 3, … 999
}

TEST_P(Lists, SearchForTextInWhichSignsAreThemselves) {
  const auto added = store_.write([](Writing& tx) -> core::Result<void> {
    for (const char* name : {"Ada 50%_hand", "ada 50 hand", "Eve's !", "Ö"})
      TRY(add_account(tx, {.id = std::string("id-") + name, .name = name, .password_hash = "h"},
                      0));
    return {};
  });
  ASSERT_TRUE(added) << added.error().what;
  const auto of = [&](const std::string& text) { return names_of(found({.search = text})); };
  EXPECT_EQ(of("ADA").size(), 2u) << "without regard to case";
  EXPECT_EQ(of("0%_H"), Names{"Ada 50%_hand"});
  EXPECT_EQ(of("'s !"), Names{"Eve's !"});
  EXPECT_EQ(of("Ö"), Names{"Ö"});
  EXPECT_EQ(of("' or 1=1 --"), Names{});
  EXPECT_EQ(found({.search = "nobody"}).page.total, 0);
}

TEST_P(Lists, RefuseWordsThatTheyDoNotHave) {
  add(0, 3);
  EXPECT_EQ(refusal({.sort = "password_hash"}), "sort: name, role, level, made is expected");
  EXPECT_EQ(refusal({.filters = {{"state", "asleep"}}}), "state: active, disabled is expected");
  EXPECT_EQ(refusal({.filters = {{"id", "1"}}}),
            "id: this filter is unknown: role, state is expected");
  const std::string next = found({.limit = 1}).page.next;
  for (const ListRequest& bad : std::vector<ListRequest>{
           {.cursor = "x"},
           {.cursor = next.substr(1)},
           {.cursor = std::string(5000, 'A')},
           {.sort = "role", .cursor = next},
           {.descending = true, .cursor = next},
           {.cursor = core::base64url(core::bytes_of(R"(["name","up","next",1,2])"))},
           {.cursor = core::base64url(core::bytes_of(R"(["name","up","other","a","b"])"))}})
    EXPECT_TRUE(refusal(bad).starts_with("cursor: ")) << refusal(bad);
  EXPECT_NE(refusal({.search = std::string("a\0b", 3)}), "");
}

/// SQLite tells how it would find the rows: along an index, so that a page ends the work.
TEST(ListOrders, EachHasAnIndex) {
  const test_support::TestDatabase database(test_support::DatabaseKind::sqlite);
  Store store = database.open();
  const std::vector<std::pair<ListShape, std::string>> lists{
      {trial_list(), ""},
      {assignment_list(), ""},
      {account_list(), ""},
      {audit_list(), ""},
      {case_list(), " and c.kind = 'palpation'"}};
  for (const auto& [shape, reach] : lists)
    for (const ListOrder& order : shape.orders) {
      std::string columns;
      for (const OrderColumn& column : order.columns)
        columns += (columns.empty() ? "" : ", ") + column.sql;
      const auto plan = store.read([&](Reading& tx) {
        return tx.query("explain query plan select " + columns + " from " + shape.from +
                        " where 1 = 1" + reach + " order by " + columns + " limit 50");
      });
      ASSERT_TRUE(plan) << plan.error().what;
      for (const Row& row : *plan)
        EXPECT_EQ(row.text(3).find("TEMP B-TREE"), std::string::npos)
            << shape.from << " by " << order.name << ": " << row.text(3);
    }
}

TEST_P(Lists, KeepTheViewsOfEachAccountApart) {
  add(0, 2);
  const auto save = [&](const std::string& id, const std::string& account, const std::string& name,
                        const std::string& search) {
    return store_.write([&](Writing& tx) {
      return save_view(tx, {id, account, ListedPage::trials, name, search, 1});
    });
  };
  const auto views = [&](const std::string& account) {
    Names out;
    const auto read = store_.read([&](Reading& tx) { return saved_views_of(tx, account); });
    for (const SavedView& view : read.value()) out.push_back(view.name + " " + view.search);
    return out;
  };
  ASSERT_TRUE(save("v1", "id-0000", "mine", "find=a"));
  ASSERT_TRUE(save("v2", "id-0000", "mine", "find=b"));
  ASSERT_TRUE(save("v3", "id-0001", "mine", "find=c"));
  EXPECT_EQ(views("id-0000"), Names{"mine find=b"}) << "the same name replaces";
  EXPECT_EQ(views("id-0001"), Names{"mine find=c"});
  const auto remove = [&](const std::string& account, const std::string& id) {
    return store_.write([&](Writing& tx) { return remove_view(tx, account, id); });
  };
  EXPECT_FALSE(remove("id-0001", "v1")) << "another's";
  EXPECT_TRUE(remove("id-0000", "v1"));
  EXPECT_EQ(views("id-0000"), Names{});
  for (int i = 0; i < kMaxViews; ++i)
    ASSERT_TRUE(save(fmt::format("w{}", i), "id-0000", fmt::format("view {}", i), ""));
  EXPECT_FALSE(save("more", "id-0000", "one more", ""));
  EXPECT_EQ(views("id-0000").size(), std::size_t(kMaxViews));
}

}  // namespace
}  // namespace store
}  // namespace tractus
