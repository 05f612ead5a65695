#include "tests/bench/stations_load/many/check.hpp"

#include <fmt/format.h>

#include <map>

#include "core/try.hpp"
#include "db/store/database/connection.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus {
namespace many {
namespace fs = std::filesystem;
namespace {

core::Result<store::Rows> rows_of(store::Connection& records, const std::string& sql) {
  return records.query(sql, {});
}

core::Result<std::uint64_t> count_of(store::Connection& records, const std::string& sql) {
  auto rows = TRY(rows_of(records, sql));
  return rows.front().count(0);
}

/// Trials by id with their number of samples, page by page, through the proxy.
core::Result<std::map<std::string, std::uint64_t>> listed(const Setup& setup) {
  auto cookie = TRY(load::sign_in(setup.url(), setup.authority()));
  auto server = TRY(uplink::HttpServer::make_nameless(setup.url(), setup.authority()));
  std::map<std::string, std::uint64_t> out;
  for (std::string cursor, next = "first"; !next.empty(); cursor = "&cursor=" + next) {
    const uplink::Request request{.method = "GET",
                                  .path = "/api/v1/trials?limit=200" + cursor,
                                  .headers = {{"Cookie", cookie}},
                                  .max_answer_bytes = 16u << 20};
    auto answer = TRY(server->send(request));
    auto page = TRY(uplink::json_of(request, answer));
    for (const core::Json& trial : page["trials"])
      out[trial["id"].get<std::string>()] = trial["samples"].get<std::uint64_t>();
    next = page["next"].is_string() ? page["next"].get<std::string>() : "";
  }
  return out;
}

}  // namespace

core::Result<Checked> check(const Setup& setup, const std::vector<Committed>& trials) {
  Checked out;
  auto records = store::postgres_connection(setup.database(), store::Access::read);
  TRY(records->begin(store::Access::read));
  std::map<std::string, std::string> sha256_of;
  auto rows = TRY(rows_of(*records, "select id, sha256 from trials"));
  for (const store::Row& row : rows) sha256_of[row.text(0)] = row.text(1);
  out.unfinished =
      TRY(count_of(*records, "select count(*) from uploads where state <> 'complete'"));
  out.jobs_waiting = TRY(count_of(*records, "select count(*) from jobs where state <> 'done'"));
  TRY(records->commit());
  auto on_list = TRY(listed(setup));
  for (const Committed& trial : trials) {
    if (const auto at = on_list.find(trial.id); at == on_list.end() || at->second != trial.samples)
      ++out.unlisted;
    const auto known = sha256_of.find(trial.id);
    if (known == sha256_of.end()) {
      ++out.missing;
      continue;
    }
    const fs::path file =
        setup.data() / "objects" / known->second.substr(0, 2) / known->second.substr(2);
    std::error_code failure;
    const auto sha256 = store::file_sha256(file);
    if (fs::file_size(file, failure) != trial.size_bytes || !sha256 || *sha256 != trial.sha256)
      ++out.different;
  }
  out.verified = load::run({"verify", "--data", setup.data()}, setup.folder() / "verify.log");
  return out;
}

}  // namespace many
}  // namespace tractus
