#include "db/store/cases/cases.hpp"

#include "core/try.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kSummary =
    "select c.id, c.title, c.source, c.made_utc_us, "
    "(select count(*) from trials t where t.case_id = c.id), c.kind, "
    "case when c.retired_utc_us is null then 0 else 1 end, c.planned, c.felt from cases c ";

core::Result<CaseSummary> case_from(const Row& row) {
  const auto kind = TRY(row.word<trial::Rig>(5, "cases.kind"));
  const auto felt = TRY(row.word<Felt>(8, "cases.felt"));
  return CaseSummary{row.text(0),  row.text(1),  row.text(2), row.integer(3), row.count(4), kind,
                     row.truth(6), row.truth(7), felt};
}

core::Result<void> add_part(Writing& tx, const std::string& case_id, const CasePart& part,
                            std::int64_t now_utc_us) {
  TRY(add_object(tx, part.sha256, part.size_bytes, now_utc_us));
  TRY(tx.query(
      "insert into case_parts (case_id, name, sha256, size_bytes, secret) "
      "values (?, ?, ?, ?, ?) on conflict (case_id, name) do nothing",
      {case_id, part.name, part.sha256, count_value(part.size_bytes), bool_value(part.secret)}));
  return {};
}

}  // namespace

core::Result<void> add_object(Writing& tx, const std::string& sha256, std::uint64_t size_bytes,
                              std::int64_t now_utc_us) {
  TRY(
      tx.query("insert into objects (sha256, size_bytes, made_utc_us) values (?, ?, ?) "
               "on conflict (sha256) do nothing",
               {sha256, count_value(size_bytes), now_utc_us}));
  return {};
}

core::Result<std::uint64_t> object_size_bytes(Reading& tx, const std::string& sha256) {
  auto rows = TRY(tx.query("select size_bytes from objects where sha256 = ?", {sha256}));
  return rows.empty() ? 0 : rows.front().count(0);
}

core::Result<void> add_case(Writing& tx, const CaseSummary& summary,
                            const std::vector<CasePart>& parts, std::int64_t now_utc_us) {
  TRY(tx.query(
      "insert into cases (id, title, source, made_utc_us, published_utc_us, kind, planned, "
      "felt) values (?, ?, ?, ?, ?, ?, ?, ?) on conflict (id) do update set planned = ?",
      {summary.id, summary.title, summary.source, summary.made_utc_us, now_utc_us,
       name_value(summary.kind), bool_value(summary.planned), name_value(summary.felt),
       bool_value(summary.planned)}));
  for (const CasePart& part : parts) TRY(add_part(tx, summary.id, part, now_utc_us));
  return {};
}

core::Result<void> set_case_felt(Writing& tx, const std::string& id, Felt felt,
                                 const std::optional<CasePart>& certificate,
                                 std::int64_t now_utc_us) {
  const auto rows = TRY(tx.query("update cases set felt = ? where id = ? and felt = ? returning id",
                                 {name_value(felt), id, name_value(Felt::untried)}));
  if (!rows.empty() && certificate) TRY(add_part(tx, id, *certificate, now_utc_us));
  return {};
}

core::Result<std::vector<std::string>> untried_cases(Reading& tx) {
  const auto rows = TRY(tx.query(
      "select id from cases where kind = ? and felt = ? and not exists (select 1 from "
      "jobs where jobs.kind = ? and jobs.subject = cases.id) "
      "order by published_utc_us, id",
      {name_value(trial::Rig::palpation), name_value(Felt::untried), name_value(JobKind::felt)}));
  std::vector<std::string> out;
  for (const Row& row : rows) out.push_back(row.text(0));
  return out;
}

const ListShape& case_list() {
  using enum ColumnType;
  const OrderColumn key{"c.id"};
  static const ListShape kShape{
      .from = "cases c",
      .searched = "c.title || ' ' || c.source || ' ' || c.id",
      .orders = {{"published", {{"c.published_utc_us", integer}, key}, true},
                 {"title", {{"c.title"}, key}},
                 {"source", {{"c.source"}, key}},
                 {"made", {{"c.made_utc_us", integer}, key}, true}},
      .filters = {
          {"state",
           "Only cases that new assignments can use (available), or cannot (retired)",
           {{"available", "c.retired_utc_us is null"},
            {"retired", "c.retired_utc_us is not null"}}},
          {"channel",
           "Only cases whose channel is there already (drilled), or which the trainee drills "
           "(planned)",
           {{"drilled", "c.planned = 0"}, {"planned", "c.planned = 1"}}},
          {"felt", "Only cases of which the certificate says this", choices_of<Felt>("c.felt")}}};
  return kShape;
}

core::Result<FoundCases> find_cases(Reading& tx, const ListRequest& request) {
  const Reach palpation{.sql = " and coalesce(c.kind, '') = ?",  // a scan, not an index of an order
                        .walked = " and c.kind = ?",
                        .values = {name_value(trial::Rig::palpation)}};
  auto found = TRY(find_keys(tx, case_list(), request, palpation));
  const SqlPart select{std::string(kSummary) + "where c.id in"};
  auto cases = TRY(all_of(rows_of_keys(tx, select, found.keys), case_from));
  return FoundCases{std::move(cases), std::move(found.page)};
}

core::Result<std::optional<CaseSummary>> case_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kSummary) + "where c.id = ?", {id}), case_from);
}

core::Result<void> set_case_retired(Writing& tx, const std::string& id, bool retired,
                                    std::int64_t now_utc_us) {
  auto rows = TRY(tx.query("update cases set retired_utc_us = ? where id = ? returning id",
                           {retired ? Value(now_utc_us) : Value(), id}));
  if (rows.empty()) return core::Error{core::Errc::not_found, "no case " + id.substr(0, 64)};
  return {};
}

core::Result<std::optional<CasePart>> case_part(Reading& tx, const std::string& case_id,
                                                const std::string& name) {
  auto rows = TRY(tx.query(
      "select name, sha256, size_bytes, secret from case_parts where case_id = ? and name = ?",
      {case_id, name}));
  if (rows.empty()) return std::optional<CasePart>();
  const Row& row = rows.front();
  return std::optional(CasePart{row.text(0), row.text(1), row.count(2), row.truth(3)});
}

}  // namespace store
}  // namespace tractus
