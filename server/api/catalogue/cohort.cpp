/// A cohort: its scored trials as a table, and statistical methods on it.
#include "server/api/cohort_table.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace api {
namespace {
using namespace schema;

constexpr std::uint64_t kMaxAsk_bytes = 16384;

core::Result<http::Response> analyse_cohort(const Call& call) {
  const auto asked = core::parse_json(call.request.body, "body");
  if (!asked) return asked.error();
  const auto answer = cohort_analysis(call.backend, *asked);
  if (!answer) return answer.error();
  return json_response(*answer);
}

core::Result<http::Response> table_of(const Call& call) {
  auto table = cohort_table(call.backend, call.has("study") ? call.text("study") : "");
  if (!table) return table.error();
  http::Response response{.status = 200, .headers = {}, .body = std::move(table->csv)};
  response.with("Content-Type", "text/csv; charset=utf-8")
      .with("Content-Disposition", "attachment; filename=\"cohort.csv\"")
      .with("Cache-Control", "no-store");
  return response;
}

std::vector<NamedSchema> cohort_schemas() {
  return {{"CohortQuestion",
           object({{"method", text("as of `tractus stats`: anova, ols, lmm, …")},
                   {"formula", optional(text("of the table's columns: correct ~ level"))},
                   {"options", optional(anything("the method's, by name: texts or numbers"))},
                   {"study", optional(text("trials of this study alone"))}})},
          {"CohortAnalysis",
           object({{"method", text("as asked")},
                   {"formula", text("as asked")},
                   {"study", nullable(text("as asked; null: all trials"))},
                   {"rows", integer("1", "trials in the table")},
                   {"rows_simulated", integer("1", "of them by a simulated hand or machine")},
                   {"left_out",
                    object({{"invalid", integer("1", "trials that do not count, or cut short")},
                            {"unscored", integer("1", "trials without scores")}})},
                   {"sha256", text("of the table as CSV")},
                   {"report", anything("the method's: blocks, tables, tests, checks, notes")}})}};
}

}  // namespace

std::vector<RouteInfo> cohort_routes() {
  return {{.method = "POST",
           .path = "/api/v1/cohort/analyses",
           .id = "analyseCohort",
           .summary = "A statistical method on the table of the scored trials",
           .who = {Role::admin},
           .parameters = {},
           .body = "CohortQuestion",
           .body_limit_bytes = kMaxAsk_bytes,
           .answer = "CohortAnalysis",
           .schemas = cohort_schemas(),
           .handle = analyse_cohort},
          {.method = "GET",
           .path = "/api/v1/cohort/table",
           .id = "cohortTable",
           .summary = "The scored trials as CSV, one row each",
           .who = {Role::admin},
           .parameters = {{.in = Parameter::In::query,
                           .name = "study",
                           .kind = Parameter::Kind::text,
                           .unit = "",
                           .meaning = "trials of this study alone",
                           .required = false,
                           .fallback = std::nullopt}},
           .body = "",
           .answer = kBytes,
           .schemas = {},
           .handle = table_of}};
}

}  // namespace api
