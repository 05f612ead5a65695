/// backup, restore, verify, migrate.
#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "server/app/anchors.hpp"
#include "server/app/command.hpp"
#include "server/app/maintenance.hpp"

namespace tractus {
namespace app {
namespace {

constexpr std::size_t kShown = 20;

std::string coverage_text(const Examined& e) {
  if (e.found.covered_since_utc_us == 0)
    return "the audit trail does not cover the rows of tables yet; this begins when this program "
           "version serves the folder";
  return fmt::format(
      "the audit trail covers the rows of {} tables since {}; {} anchors, the newest of {}",
      e.found.covered_tables, core::utc_text(e.found.covered_since_utc_us), e.anchors.anchors,
      core::utc_text(e.anchors.newest_utc_us));
}

std::string findings_text(const std::vector<std::string>& lines) {
  if (lines.empty()) return "no errors found";
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, lines.size()); ++i)
    out += (i ? "\n" : "") + lines[i];
  if (lines.size() > kShown) out += fmt::format("\nand {} more", lines.size() - kShown);
  return out;
}

/// 0: nothing is wrong; 1: something is.
int say_examined(const Common& common, const Examined& examined) {
  const store::Findings& found = examined.found;
  const bool fine = found.lines.empty();
  say(common.json,
      {{"holds", fine},
       {"findings", found.lines},
       {"objects", found.objects},
       {"bytes", found.bytes},
       {"audit_rows", found.audit.number},
       {"audit_hash", found.audit.hash},
       {"anchors", examined.anchors.anchors},
       {"covered_since_utc_us", found.covered_since_utc_us}},
      fmt::format("{}\n{} objects, {} bytes, {} rows of the audit trail{}\n{}",
                  findings_text(found.lines), found.objects, found.bytes, found.audit.number,
                  fine ? "; it ends with " + found.audit.hash.substr(0, 16) : "",
                  coverage_text(examined)));
  return fine ? 0 : 1;
}

/// What the restored folder knows of people who left since the backup was made.
std::string erasures_text(const core::Json& manifest) {
  if (manifest.value("erasure_lists", 0) == 0)
    return "no list of erasures was found beside the backup, and none was given with --erasures: "
           "people who were erased since the backup was made are in the restored folder again";
  return fmt::format("{} people who left since the backup was made were erased again",
                     manifest.value("erased", 0));
}

/// Rows that are not covered are a finding, but not of a backup that is from before they were.
enum class Covered { must_be, may_be };

core::Result<int> verified(const Common& common, Covered covered,
                           const std::optional<std::filesystem::path>& anchors = {}) {
  auto data = TRY(open_up_to_date(common.data));
  auto examined = TRY(examine(data, core::terminal_progress("Checking"), anchors));
  if (covered == Covered::must_be && examined.found.covered_since_utc_us == 0)
    examined.found.lines.push_back("audit trail: it does not cover the rows of tables");
  return say_examined(common, examined);
}

}  // namespace

Run backup_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto out = std::make_shared<std::filesystem::path>();
  command.add_option("--out", *out, "Folder of the new backup; it must not exist")->required();
  return [=]() -> core::Result<int> {
    auto made = TRY(back_up(common->data, *out, core::terminal_progress("Backup")));
    say(common->json, {{"backup", out->string()}, {"rows", made["rows"]}},
        fmt::format("{}: {} trials, {} objects, {} bytes", out->string(),
                    made["rows"]["trials"].dump(), made["rows"]["objects"].dump(),
                    made["object_bytes"].dump()));
    return 0;
  };
}

Run restore_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto from = std::make_shared<std::filesystem::path>();
  const auto erasures = std::make_shared<std::filesystem::path>();
  const auto objects = objects_option(command);
  command.add_option("--from", *from, "Folder of the backup")->required();
  command.add_option("--erasures", *erasures,
                     "File erasures.list of the server's data folder: people who were erased since "
                     "the backup was made are erased again. The list beside the backup's folder is "
                     "used without this option");
  return [=]() -> core::Result<int> {
    auto target = TRY(new_database(common->data));
    const auto manifest = TRY(restore(*from, common->data, {target, *objects},
                                      core::terminal_progress("Restore"), *erasures));
    if (!common->json) fmt::print("{}\n", erasures_text(manifest));
    return verified(*common, Covered::may_be);
  };
}

Run verify_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto anchors = std::make_shared<std::filesystem::path>();
  command.add_option("--anchors", *anchors,
                     "Copy of the anchors that the server wrote with serve --anchors-to: a file, "
                     "or lines of a system journal");
  return [=]() {
    return verified(*common, Covered::must_be,
                    anchors->empty() ? std::nullopt : std::optional(*anchors));
  };
}

Run anchor_command(CLI::App& command) {
  const auto common = common_options(command);
  return [=]() -> core::Result<int> {
    auto data = TRY(open_up_to_date(common->data));
    auto wrong = TRY(check_anchors(common->data, data.secrets.audit_key()));
    const auto act = command_act("anchor", {{"findings", wrong.findings}});
    TRY(data.store.write(
        [&](store::Writing& tx) { return store::add_act(tx, data.store.audit_key(), act); }));
    TRY(begin_anchors_again(data));
    say(common->json, {{"findings", wrong.findings}},
        "new anchors start at the present end of the audit trail; the audit trail records this");
    return 0;
  };
}

Run migrate_command(CLI::App& command) {
  const auto common = common_options(command);
  return [=]() -> core::Result<int> {
    const auto database = TRY(database_of(common->data));
    auto before = TRY(schema_of(database));
    TRY(open_data(common->data));
    auto after = TRY(schema_of(database));
    say(common->json, {{"before", before}, {"after", after}},
        before == after ? fmt::format("the database has schema {}: it is up to date", after)
                        : fmt::format("the database went from schema {} to {}", before, after));
    return 0;
  };
}

}  // namespace app
}  // namespace tractus
