/// init, enrol, publish: what is done before and beside serving.
#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/people/accounts.hpp"
#include "server/api/people/authentication.hpp"
#include "server/app/anchors.hpp"
#include "server/app/command.hpp"
#include "server/app/data_folder.hpp"
#include "server/app/publish.hpp"
#include "server/http/certificates.hpp"

namespace tractus {
namespace app {
namespace {

/// The first line of a file, or a generated one.
core::Result<std::string> password_from(const std::string& file) {
  if (file.empty()) return core::hex(core::random_bytes(12));
  auto bytes = TRY(core::read_file(file, 4096));
  std::string line(core::text_of(bytes));
  line = line.substr(0, line.find_first_of("\r\n"));
  if (line.size() < 12 || line.size() > api::kMaxPassword)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: line 1: {} characters, 12 to {} are expected", file,
                                   line.size(), api::kMaxPassword)};
  return line;
}

Outcome make_account(DataFolder& data, const std::string& name, const std::string& password) {
  auto hash = TRY(api::password_hash(password));
  const store::AuditScope acting(command_act("init", {{"name", name}}));
  return data.store.write([&](store::Writing& tx) {
    return store::add_account(tx, {core::new_id(), name, store::Role::admin, hash}, core::utc_us());
  });
}

}  // namespace

Run init_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto name = std::make_shared<std::string>("admin");
  const auto file = std::make_shared<std::string>();
  const auto objects = objects_option(command);
  command.add_option("--admin-name", *name, "Name of the first account, an administrator")
      ->capture_default_str();
  const auto hosts = std::make_shared<std::vector<std::string>>();
  command.add_option(
      "--host", *hosts,
      "Host name or address under which stations and browsers reach the server; may be repeated");
  command.add_option("--password-file", *file,
                     "File whose first line is the password of the first account; if it is "
                     "missing, a password is generated and printed once");
  return [=]() -> core::Result<int> {
    if (name->empty() || name->size() > api::kMaxName)
      return core::Error{
          core::Errc::bad_input,
          fmt::format("--admin-name: 1 to {} characters are expected", api::kMaxName)};
    auto password = TRY(password_from(*file));
    auto data = TRY(make_data(common->data, *objects));
    TRY(begin_trail(data));
    TRY(make_account(data, *name, password));
    auto names = http::own_names();
    names.insert(names.end(), hosts->begin(), hosts->end());
    const auto tls = common->data / kCertificates;
    TRY(http::ensure_certificates(tls, names, core::utc_us() / 1'000'000));
    const auto authority = http::certificate_files(tls).authority;
    auto print = TRY(http::fingerprint(authority));
    core::Json said{{"data", common->data.string()},
                    {"name", *name},
                    {"authority", authority.string()},
                    {"authority_sha256", print}};
    std::string line = fmt::format(
        "{}: account {} is ready; stations and browsers must trust the certificate {} (SHA-256 {})",
        common->data.string(), *name, authority.string(), print);
    if (file->empty()) {
      said["password"] = password;
      line += fmt::format("; its password, shown only now: {}", password);
    }
    say(common->json, said, line);
    return 0;
  };
}

namespace {

/// A new file that only its owner reads.
Outcome write_secret(const std::filesystem::path& path, const std::string& text) {
  if (std::filesystem::exists(path))
    return core::Error{core::Errc::conflict, path.string() + ": exists already"};
  return core::write_file(path, core::bytes_of(text + "\n"));
}

}  // namespace

Run enrol_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto name = std::make_shared<std::string>();
  const auto out = std::make_shared<std::filesystem::path>();
  command.add_option("--name", *name, "Name of the station")->required();
  command.add_option("--out", *out, "File for the token of the station; it must not exist")
      ->required();
  return [=]() -> core::Result<int> {
    if (name->empty() || name->size() > api::kMaxName)
      return core::Error{core::Errc::bad_input,
                         fmt::format("--name: 1 to {} characters are expected", api::kMaxName)};
    auto data = TRY(open_up_to_date(common->data));
    const std::string token = api::new_token();
    TRY(write_secret(*out, token));
    const store::AuditScope acting(command_act("enrol", {{"name", *name}}));
    auto added = data.store.write([&](store::Writing& tx) {
      return store::add_station(tx, {core::new_id(), *name}, api::token_hash(token),
                                core::utc_us());
    });
    if (!added) {
      std::filesystem::remove(*out);
      return added.error();
    }
    const std::string signer = data.secrets.case_key().public_hex;
    say(common->json, {{"station", *name}, {"token_file", out->string()}, {"case_signer", signer}},
        fmt::format("station {} is enrolled; its token is in {}; to let the station accept cases "
                    "made on this server: tractus-station trust --signer {}",
                    *name, out->string(), signer));
    return 0;
  };
}

Run publish_command(CLI::App& command) {
  const auto common = common_options(command);
  const auto bundle = std::make_shared<std::filesystem::path>();
  command.add_option("bundle", *bundle, "Folder of the case that `tractus carve` made")->required();
  return [=]() -> core::Result<int> {
    auto data = TRY(open_up_to_date(common->data));
    auto id = TRY(publish(data, *bundle));
    say(common->json, {{"case_id", id}}, "published case " + id);
    return 0;
  };
}

}  // namespace app
}  // namespace tractus
