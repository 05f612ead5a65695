/// `tractus-server`: the command line.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/stat.h>

#include <cstdio>

#include "core/words.hpp"
#include "server/app/command.hpp"
#include "server/app/database.hpp"
#include "server/app/import_process.hpp"

namespace tractus {
namespace app {

void say(bool json, const core::Json& object, const std::string& line) {
  fmt::print("{}\n", json ? object.dump() : line);
}

std::shared_ptr<Common> common_options(CLI::App& command) {
  auto common = std::make_shared<Common>();
  command.add_option("--data", common->data, "Data folder of the server")->required();
  command.add_flag("--json", common->json, "Print the result as JSON");
  command
      .add_option_function<std::string>(
          "--database",
          [](const std::string& address) {
            if (auto used = use_address(address); !used)
              throw CLI::ValidationError(used.error().what);
          },
          "Address of a PostgreSQL database for the records, postgresql://[USER@]HOST[:PORT]/NAME, "
          "instead of a database file in the data folder; init and restore store the address in "
          "the data folder. Give an address with a password in the variable TRACTUS_DATABASE, or "
          "give the password in PGPASSFILE")
      ->type_name("ADDRESS");
  return common;
}

std::shared_ptr<std::string> objects_option(CLI::App& command) {
  auto address = std::make_shared<std::string>();
  command
      .add_option("--objects", *address,
                  "Address of an S3 bucket for volumes, trials and all other finished files, "
                  "https://HOST[:PORT]/BUCKET[/PREFIX][?region=REGION], instead of the data "
                  "folder, which holds a cache of them then; the address is stored in the data "
                  "folder. Give the credentials in AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or "
                  "in the file that AWS_SHARED_CREDENTIALS_FILE names (default: "
                  "~/.aws/credentials)")
      ->envname("TRACTUS_OBJECTS")
      ->type_name("ADDRESS");
  return address;
}

}  // namespace app

namespace {

struct Command {
  const char* name;
  const char* summary;
  const char* example;
  app::Run (*make)(CLI::App&);
};

constexpr Command kCommands[] = {
    {"init", "Create a data folder and its first account",
     "tractus-server init --data /srv/tractus --admin-name admin", app::init_command},
    {"enrol", "Enrol a station and write its token to a file",
     "tractus-server enrol --data /srv/tractus --name station-1 --out station-1.token",
     app::enrol_command},
    {"publish", "Check the signature and files of a case, and publish the case to stations",
     "tractus-server publish --data /srv/tractus cases/l3-medial", app::publish_command},
    {"serve", "Run the server for stations and browsers until it is stopped",
     "tractus-server serve --data /srv/tractus --listen 127.0.0.1:8480 --web web/dist",
     app::serve_command},
    {"backup", "Make a backup of a data folder in a new folder; the server may run meanwhile",
     "tractus-server backup --data /srv/tractus --out /backup/tractus-monday", app::backup_command},
    {"restore", "Restore a backup to a new data folder, and check the data folder",
     "tractus-server restore --from /backup/tractus-monday --data /srv/tractus",
     app::restore_command},
    {"verify",
     "Check a data folder: database, files, audit trail, anchors, and the database rows that the "
     "audit trail covers; the exit code is 1 if there is an error",
     "tractus-server verify --data /srv/tractus --anchors /mnt/other/anchors", app::verify_command},
    {"anchor",
     "Start new anchors of the audit trail after the old ones were lost; the audit trail records "
     "this",
     "tractus-server anchor --data /srv/tractus", app::anchor_command},
    {"migrate", "Migrate the database to the schema of this program version",
     "tractus-server migrate --data /srv/tractus", app::migrate_command},
    {"upgrade", "Say whether this program version can take over a data folder; changes nothing",
     "tractus-server upgrade --check --data /srv/tractus", app::upgrade_command},
    {"openapi", "Print the description of the API in OpenAPI 3.1 format",
     "tractus-server openapi > openapi.json", app::openapi_command},
    {"import-volume", "", "tractus-server import-volume --upload FILE --folder FOLDER",
     app::import_volume_command},  // run by the server as a child process
};

/// Exit code when CLI11 ends the program: 0 for --help, 2 for wrong usage, with one line of
/// explanation.
int ended_by(const CLI::App& commands, const CLI::ParseError& end) {
  if (end.get_exit_code() == 0) return commands.exit(end);
  fmt::print(stderr, "tractus-server: {} (see --help)\n", end.what());
  return 2;
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  ::umask(0077);  // only the owner may access files that this program creates
  // Freed memory is kept for the next request: fetching it anew, page by page, took a third of the
  // time of an upload. It goes back to the system every two seconds (freed_memory.hpp). Buffers of
  // a megabyte and more go back at once: among small ones they leave gaps that are never filled.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 64 << 20);
  CLI::App commands{"Tractus server: cases, trials and their assessment", "tractus-server"};
  commands.require_subcommand(1);
  commands.set_version_flag("--version", TRACTUS_VERSION);
  commands.footer(
      "Example: tractus-server init --data /srv/tractus && tractus-server serve --data "
      "/srv/tractus");
  app::Run chosen;
  for (const Command& command : kCommands) {
    CLI::App* sub = commands.add_subcommand(command.name, command.summary);
    sub->footer(std::string("Example: ") + command.example);
    if (std::string(command.name) == "serve") sub->alias("run");
    if (std::string(command.summary).empty()) sub->group("");  // not shown in --help
    sub->callback([&chosen, run = command.make(*sub)] { chosen = run; });
  }
  try {
    commands.parse(argc, argv);
  } catch (const CLI::ParseError& end) {
    return ended_by(commands, end);
  }
  const core::Result<int> outcome = chosen();
  if (outcome) return *outcome;
  fmt::print(stderr, "tractus-server: {}\n", core::one_line(outcome.error().what, 4000));
  return 2;
}
