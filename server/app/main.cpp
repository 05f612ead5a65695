/// `tractus-server`: the command line.
#include <fmt/format.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "db/store/accounts.hpp"
#include "server/api/authentication.hpp"
#include "server/api/openapi.hpp"
#include "server/app/data_folder.hpp"
#include "server/app/publish.hpp"
#include "server/app/serve.hpp"

namespace {

using Outcome = core::Result<void>;
using Run = std::function<Outcome()>;

void say(bool json, const core::Json& object, const std::string& line) {
  fmt::print("{}\n", json ? object.dump() : line);
}

struct Common {
  std::filesystem::path data;
  bool json = false;
};

std::shared_ptr<Common> common_options(CLI::App& command) {
  auto common = std::make_shared<Common>();
  command.add_option("--data", common->data, "The server's data folder")->required();
  command.add_flag("--json", common->json, "Answer as JSON");
  return common;
}

/// The first line of a file, or a generated one.
core::Result<std::string> password_from(const std::string& file) {
  if (file.empty()) return core::hex(core::random_bytes(12));
  auto bytes = core::read_file(file, 4096);
  if (!bytes) return bytes.error();
  std::string line(core::text_of(*bytes));
  line = line.substr(0, line.find_first_of("\r\n"));
  if (line.size() < 12 || line.size() > api::kMaxPassword)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: line 1: {} characters, 12 to {} are expected", file,
                                   line.size(), api::kMaxPassword)};
  return line;
}

Outcome make_account(app::DataFolder& data, const std::string& name, const std::string& password) {
  auto hash = api::password_hash(password);
  if (!hash) return hash.error();
  const store::Acting acting(app::command_act("init", {{"name", name}}));
  return data.store.write([&](store::Writing& tx) {
    return store::add_account(tx, {core::new_id(), name, "admin", *hash}, core::utc_us());
  });
}

Run init_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto name = std::make_shared<std::string>("admin");
  const auto file = std::make_shared<std::string>();
  command.add_option("--admin-name", *name, "The first account")->capture_default_str();
  command.add_option("--password-file", *file,
                     "Its password is the first line; without, one is made and printed once");
  return [=]() -> Outcome {
    if (name->empty() || name->size() > api::kMaxName)
      return core::Error{
          core::Errc::bad_input,
          fmt::format("--admin-name: 1 to {} characters are expected", api::kMaxName)};
    auto password = password_from(*file);
    if (!password) return password.error();
    auto data = app::make_data(common->data);
    if (!data) return data.error();
    if (auto made = make_account(*data, *name, *password); !made) return made;
    core::Json said{{"data", common->data.string()}, {"name", *name}};
    std::string line = fmt::format("{}: account {} is ready", common->data.string(), *name);
    if (file->empty()) {
      said["password"] = *password;
      line += fmt::format("; its password, shown only now: {}", *password);
    }
    say(common->json, said, line);
    return {};
  };
}

/// A new file that only its owner reads.
Outcome write_secret(const std::filesystem::path& path, const std::string& text) {
  if (std::filesystem::exists(path))
    return core::Error{core::Errc::conflict, path.string() + ": exists already"};
  const mode_t before = ::umask(0077);
  auto written = core::write_file(path, core::bytes_of(text + "\n"));
  ::umask(before);
  return written;
}

Run enrol_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto name = std::make_shared<std::string>();
  const auto out = std::make_shared<std::filesystem::path>();
  command.add_option("--name", *name, "The station's name")->required();
  command.add_option("--out", *out, "File for its token; must not exist")->required();
  return [=]() -> Outcome {
    if (name->empty() || name->size() > api::kMaxName)
      return core::Error{core::Errc::bad_input,
                         fmt::format("--name: 1 to {} characters are expected", api::kMaxName)};
    auto data = app::open_data(common->data);
    if (!data) return data.error();
    const std::string token = api::new_token();
    if (auto written = write_secret(*out, token); !written) return written;
    const store::Acting acting(app::command_act("enrol", {{"name", *name}}));
    auto added = data->store.write([&](store::Writing& tx) {
      return store::add_station(tx, {core::new_id(), *name}, api::token_hash(token),
                                core::utc_us());
    });
    if (!added) {
      std::filesystem::remove(*out);
      return added;
    }
    say(common->json, {{"station", *name}, {"token_file", out->string()}},
        fmt::format("station {} is enrolled; its token is in {}", *name, out->string()));
    return {};
  };
}

Run publish_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto bundle = std::make_shared<std::filesystem::path>();
  command.add_option("bundle", *bundle, "The case's folder, as `tractus carve` made it")
      ->required();
  return [=]() -> Outcome {
    auto data = app::open_data(common->data);
    if (!data) return data.error();
    auto id = app::publish(*data, *bundle);
    if (!id) return id.error();
    say(common->json, {{"case_id", *id}}, "published case " + *id);
    return {};
  };
}

Run serve_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto listen = std::make_shared<std::string>("127.0.0.1:8480");
  const auto web = std::make_shared<std::filesystem::path>();
  const auto header_s = std::make_shared<double>(10.0);
  command.add_option("--listen", *listen, "ADDRESS:PORT; port 0 takes a free one")
      ->capture_default_str();
  command.add_option("--web", *web, "Folder of the built web pages; without, the API alone");
  command.add_option("--header-seconds", *header_s, "Patience with a request's head")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  return [=]() -> Outcome {
    auto address = app::listening_address(*listen);
    if (!address) return address.error();
    app::ServeOptions options{.data = common->data, .web = {}, .http = {}, .json = common->json};
    if (!web->empty()) options.web = *web;
    options.http.address = address->first;
    options.http.port = address->second;
    options.http.header_time = std::chrono::milliseconds(std::lround(*header_s * 1000));
    return app::serve(options);
  };
}

Run openapi_command(CLI::App&) {
  return []() -> Outcome {
    fmt::print("{}\n", api::openapi(api::routes()).dump(2));
    return {};
  };
}

struct Command {
  const char* name;
  const char* summary;
  const char* example;
  Run (*make)(CLI::App&);
};

constexpr Command kCommands[] = {
    {"init", "Make a data folder and its first account",
     "tractus-server init --data /srv/tractus --admin-name admin", init_command},
    {"enrol", "Enrol a station and write its token to a file",
     "tractus-server enrol --data /srv/tractus --name station-1 --out station-1.token",
     enrol_command},
    {"publish", "Verify a case bundle and offer it to stations",
     "tractus-server publish --data /srv/tractus cases/l3-medial", publish_command},
    {"serve", "Serve stations and browsers until stopped",
     "tractus-server serve --data /srv/tractus --listen 127.0.0.1:8480 --web web/dist",
     serve_command},
    {"openapi", "Print the description of the API, OpenAPI 3.1",
     "tractus-server openapi > openapi.json", openapi_command},
};

/// Exit code of CLI11's own end: 0 for --help, 2 for bad use, said in one line.
int ended_by(const CLI::App& app, const CLI::ParseError& end) {
  if (end.get_exit_code() == 0) return app.exit(end);
  fmt::print(stderr, "tractus-server: {} (see --help)\n", end.what());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Tractus server: cases, trials and their assessment", "tractus-server"};
  app.require_subcommand(1);
  app.set_version_flag("--version", TRACTUS_VERSION);
  app.footer(
      "Example: tractus-server init --data /srv/tractus && tractus-server serve --data "
      "/srv/tractus");
  Run chosen;
  for (const Command& command : kCommands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->footer(std::string("Example: ") + command.example);
    sub->callback([&chosen, run = command.make(*sub)] { chosen = run; });
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& end) {
    return ended_by(app, end);
  }
  const Outcome outcome = chosen();
  if (outcome) return 0;
  fmt::print(stderr, "tractus-server: {}\n", outcome.error().what);
  return 2;
}
