/// enrol: a key of the station's own, known to the server by its hash alone.
#include <fmt/format.h>

#include <cstdio>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/commands.hpp"
#include "station/session/station_folder.hpp"
#include "station/uplink/http_server.hpp"

namespace tractus {
namespace app {
namespace {

/// A new file that only its owner reads.
core::Result<void> write_key(const std::filesystem::path& path, const std::string& key) {
  std::error_code failure;
  if (std::filesystem::exists(path, failure))
    return core::Error{core::Errc::conflict,
                       path.string() + ": exists already; a station is enrolled once"};
  return core::write_file(path, core::bytes_of(key + "\n"));
}

/// What the server says of a station it has let in.
struct Enrolled {
  std::string name;
  std::string case_signer;  ///< public key; empty from a server that makes no cases
};

core::Result<Enrolled> enrolled_as(const Options& options, const std::string& key) {
  auto server = TRY(uplink::HttpServer::make_nameless(options.server_url, options.authority));
  const std::string body =
      core::Json{{"code", options.code}, {"token_sha256", core::sha256(core::bytes_of(key))}}
          .dump();
  const uplink::Request request{.method = "POST",
                                .path = "/api/v1/stations/enrol",
                                .headers = {{"Content-Type", "application/json"}},
                                .body = core::bytes_of(body)};
  auto answer = TRY(server->send(request));
  auto json = TRY(uplink::json_of(request, answer));
  core::Fields fields(json, "answer");
  fields.skip("id");
  Enrolled out{fields.text("name", 128), fields.text_or("case_signer", "", 64)};
  TRY(fields.done());
  return out;
}

/// Cases that are made on this server are taken from now on.
core::Result<void> trust(const std::filesystem::path& data, const std::string& case_signer) {
  if (data.empty() || case_signer.empty()) return {};
  auto folder = TRY(session::StationFolder::open(data));
  return folder.trust(case_signer);
}

}  // namespace

core::Result<int> enrol_station(const Options& options) {
  const std::string key = core::hex(core::random_bytes(32));
  TRY(write_key(options.token_file, key));
  auto enrolled = enrolled_as(options, key);
  if (!enrolled) {
    std::error_code ignored;
    std::filesystem::remove(options.token_file, ignored);
    return enrolled.error();
  }
  TRY(trust(options.data, enrolled->case_signer));
  const std::string file = options.token_file.string();
  if (options.json)
    fmt::print("{}\n", core::Json{{"station", enrolled->name},
                                  {"token_file", file},
                                  {"case_signer", enrolled->case_signer}}
                           .dump(2));
  else
    fmt::print("this is station {}; its key is in {}; the server signs its cases by {}\n",
               enrolled->name, file, enrolled->case_signer);
  return 0;
}

}  // namespace app
}  // namespace tractus
