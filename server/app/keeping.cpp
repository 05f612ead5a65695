/// backup, restore, verify, migrate.
#include <fmt/format.h>

#include "db/store/migrations.hpp"
#include "server/app/command.hpp"
#include "server/app/upkeep.hpp"

namespace app {
namespace {

constexpr std::size_t kShown = 20;

/// Without bringing it up to date.
core::Result<std::int64_t> schema_of(const Database& database) {
  std::unique_ptr<store::Connection> connection;
  if (database.is_shared()) {
    connection = store::postgres_connection(database.address, store::Access::read);
  } else {
    auto opened = store::open_sqlite(database.file, store::Access::read);
    if (!opened) return opened.error();
    connection = std::move(*opened);
  }
  if (auto begun = connection->begin(store::Access::read); !begun) return begun.error();
  auto rows = connection->query("select coalesce(max(version), 0) from schema_versions", {});
  if (!rows) return rows.error();
  return rows->front().integer(0);
}

/// 0: nothing is wrong; 1: something is.
core::Result<int> verified(const Common& common) {
  auto data = open_data(common.data);
  if (!data) return data.error();
  auto anchors = anchors_of(common.data);
  if (!anchors) return anchors.error();
  const auto found = store::look_over(data->store, data->objects, data->secrets.audit_key(),
                                      *anchors, core::terminal_progress("Looking over"));
  if (!found) return found.error();
  const bool fine = found->lines.empty();
  std::string lines = fine ? "nothing is wrong" : "";
  for (std::size_t i = 0; i < std::min(kShown, found->lines.size()); ++i)
    lines += (i ? "\n" : "") + found->lines[i];
  if (found->lines.size() > kShown)
    lines += fmt::format("\nand {} more", found->lines.size() - kShown);
  say(common.json,
      {{"holds", fine},
       {"findings", found->lines},
       {"objects", found->objects},
       {"bytes", found->bytes},
       {"audit_rows", found->audit.number},
       {"audit_hash", found->audit.hash}},
      fmt::format("{}\n{} objects, {} bytes, {} rows of the audit trail{}", lines, found->objects,
                  found->bytes, found->audit.number,
                  fine ? "; it ends with " + found->audit.hash.substr(0, 16) : ""));
  return fine ? 0 : 1;
}

}  // namespace

Run backup_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto out = std::make_shared<std::filesystem::path>();
  command.add_option("--out", *out, "The new folder; it must not exist")->required();
  return [=]() -> core::Result<int> {
    auto made = back_up(common->data, *out, core::terminal_progress("Backup"));
    if (!made) return made.error();
    say(common->json, {{"backup", out->string()}, {"rows", (*made)["rows"]}},
        fmt::format("{}: {} trials, {} objects, {} bytes", out->string(),
                    (*made)["rows"]["trials"].dump(), (*made)["rows"]["objects"].dump(),
                    (*made)["object_bytes"].dump()));
    return 0;
  };
}

Run restore_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto from = std::make_shared<std::filesystem::path>();
  command.add_option("--from", *from, "The backup's folder")->required();
  return [=]() -> core::Result<int> {
    auto target = new_database(common->data);
    if (!target) return target.error();
    auto made = restore(*from, common->data, *target, core::terminal_progress("Restore"));
    if (!made) return made.error();
    return verified(*common);
  };
}

Run verify_command(CLI::App& command) {
  const auto common = common_options(command);
  return [=]() { return verified(*common); };
}

Run migrate_command(CLI::App& command) {
  const auto common = common_options(command);
  return [=]() -> core::Result<int> {
    const auto database = database_of(common->data);
    if (!database) return database.error();
    auto before = schema_of(*database);
    if (!before) return before.error();
    auto data = open_data(common->data);
    if (!data) return data.error();
    auto after = schema_of(*database);
    if (!after) return after.error();
    say(common->json, {{"before", *before}, {"after", *after}},
        *before == *after ? fmt::format("the database has schema {}: it is up to date", *after)
                          : fmt::format("the database went from schema {} to {}", *before, *after));
    return 0;
  };
}

}  // namespace app
