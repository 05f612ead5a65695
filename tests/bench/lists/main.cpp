/// Pages of each list with 100 000 rows: the first, the last but one, searched and filtered, for those who may see all,
/// much and little. Times of the store alone, on SQLite and (with --postgresql) on PostgreSQL; 99 of 100 calls take at
/// most 100 ms.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>

#include "bench/support/report.hpp"
#include "core/bytes.hpp"
#include "core/json.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/trials/trials.hpp"
#include "tests/bench/lists/rows.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace {

constexpr int kRows = 100'000;
constexpr double kLimit_s = 0.1;

using store::ListPage;
using store::ListRequest;
using Find = std::function<core::Result<ListPage>(store::Reading&, const ListRequest&)>;

struct List {
  std::string name;
  const store::ListShape* shape;
  Find find;
  std::vector<std::string> searches;
};

template <class Found>
core::Result<ListPage> page_of(core::Result<Found> found) {
  if (!found) return found.error();
  return std::move(found->page);
}

std::vector<List> lists() {
  const auto trials = [](store::TrialFilter whose) -> Find {
    return [whose](auto& tx, const auto& request) {
      return page_of(store::find_trials(tx, request, whose));
    };
  };
  const auto assignments = [](store::AssignmentFilter whose) -> Find {
    return [whose](auto& tx, const auto& request) {
      return page_of(store::find_assignments(tx, request, whose));
    };
  };
  // Texts that one row has, a hundredth of the rows, every row and no row.
  const std::vector<std::string> of_trials{"pedicle 77777", "station 42", "pedicle",
                                           "nothing like it"};
  const std::vector<std::string> of_assignments{"task 77777", "week 51", "task", "nothing like it"};
  return {{"trials, all", &store::trial_list(), trials({}), of_trials},
          {"trials, half of the cohorts", &store::trial_list(), trials({.taught_by = "big"}),
           of_trials},
          {"trials, one cohort", &store::trial_list(), trials({.taught_by = "small"}), of_trials},
          {"trials, a trainee", &store::trial_list(), trials({.seen_by = "u7"}), of_trials},
          {"assignments, all", &store::assignment_list(), assignments({}), of_assignments},
          {"assignments, half of the cohorts", &store::assignment_list(),
           assignments({.led_by = "big"}), of_assignments},
          {"assignments, one cohort", &store::assignment_list(), assignments({.led_by = "small"}),
           of_assignments},
          {"assignments, a trainee", &store::assignment_list(), assignments({.done_by = "u7"}),
           of_assignments},
          {"accounts",
           &store::account_list(),
           [](auto& tx, const auto& request) { return page_of(store::find_accounts(tx, request)); },
           {"surgeon 77777", "on 77", "surgeon", "nothing like it"}},
          {"audit",
           &store::audit_list(),
           [](auto& tx, const auto& request) { return page_of(store::find_audit(tx, request)); },
           {"id=r77777", "week 77", "meeting", "nothing like it"}},
          {"cases",
           &store::case_list(),
           [](auto& tx, const auto& request) { return page_of(store::find_cases(tx, request)); },
           {"pedicle 77777", "hospital 42", "pedicle", "nothing like it"}}};
}

/// The cursor of the list's last pages: that of the first page in the other direction, turned round.
std::string turned(const std::string& cursor) {
  const auto bytes = core::base64url_decoded(cursor);
  core::Json json = core::parse_json(core::text_of(*bytes), "cursor").value();
  json[1] = json[1] == "up" ? "down" : "up";
  json[2] = "previous";
  return core::base64url(core::bytes_of(json.dump()));
}

class Measured {
 public:
  Measured(bench::Report& report, store::Store& store, std::string where, int calls)
      : report_(report), store_(store), where_(std::move(where)), calls_(calls) {}

  ListPage page(const List& list, const ListRequest& request) {
    const auto found = store_.read([&](store::Reading& tx) { return list.find(tx, request); });
    core::require(bool(found), found ? "" : found.error().what.c_str());
    return *found;
  }
  void time(const List& list, const std::string& what, const ListRequest& request) {
    std::vector<double> taken_s, worked_s;
    for (int i = 0; i < calls_; ++i) {
      const double start = bench::wall_s(), worked = bench::thread_s();
      page(list, request);
      taken_s.push_back(bench::wall_s() - start);
      worked_s.push_back(bench::thread_s() - worked);
    }
    const double p99_s = bench::quantile(taken_s, 0.99);
    report_.row(
        fmt::format("{} {}, {}: p99", where_, list.name, what), 1e3 * p99_s, "ms",
        fmt::format("{:.1f} ms of processor time here", 1e3 * bench::quantile(worked_s, 0.99)));
    worst_s_ = std::max(worst_s_, p99_s);
    worst_worked_s_ = std::max(worst_worked_s_, bench::quantile(worked_s, 0.99));
  }
  void time_all(const List& list) {
    for (const auto& order : list.shape->orders) {
      time(list, "first by " + order.name, {.sort = order.name});
      const auto other =
          page(list, {.sort = order.name, .descending = !order.descending, .limit = 200});
      if (!other.next.empty())
        time(list, "deep by " + order.name, {.sort = order.name, .cursor = turned(other.next)});
      for (const std::string& text : list.searches)
        time(list, fmt::format("'{}' by {}", text, order.name),
             {.search = text, .sort = order.name});
    }
    for (const auto& filter : list.shape->filters)
      for (const auto& choice : filter.choices)
        time(list, filter.name + " " + choice.word, {.filters = {{filter.name, choice.word}}});
  }
  double worst_s() const { return worst_s_; }
  double worst_worked_s() const { return worst_worked_s_; }

 private:
  bench::Report& report_;
  store::Store& store_;
  std::string where_;
  int calls_;
  double worst_s_ = 0.0, worst_worked_s_ = 0.0;
};

void measure(bench::Report& report, test_support::DatabaseKind kind, const std::string& where,
             int calls) {
  const test_support::TestDatabase database(kind);
  store::Store store = database.open();
  const auto connection = database.connection(store::Access::write);
  const auto added = bench::add_rows(*connection, kRows);
  core::require(bool(added), added ? "" : added.error().what.c_str());
  if (kind ==
      test_support::DatabaseKind::postgresql)  // as its own maintenance does within the minute
    core::require(bool(connection->script("analyze")), "PostgreSQL analyses its tables");
  Measured measured(report, store, where, calls);
  for (const List& list : lists()) measured.time_all(list);
  report.row(where + ": slowest p99 of processor time of this program",
             1e3 * measured.worst_worked_s(), "ms");
  report.at_most(where + ": slowest p99", measured.worst_s(), kLimit_s, "s");
}

}  // namespace
}  // namespace tractus

int main(int argc, char** argv) {
  using tractus::test_support::DatabaseKind;
  tractus::bench::Report report("lists");
  bool postgresql = false;
  int calls = 100;
  for (int i = 1; i < argc; ++i) {
    postgresql = postgresql || std::strcmp(argv[i], "--postgresql") == 0;
    if (std::strcmp(argv[i], "--calls") == 0 && i + 1 < argc)
      calls = std::max(1, std::atoi(argv[i + 1]));
  }
  tractus::measure(report, DatabaseKind::sqlite, "SQLite", calls);
  if (postgresql) tractus::measure(report, DatabaseKind::postgresql, "PostgreSQL", calls);
  return report.finish(argc, argv);
}
