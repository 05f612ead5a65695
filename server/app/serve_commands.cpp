/// serve (also called run), openapi.
#include <fmt/format.h>

#include <cmath>

#include "core/try.hpp"
#include "server/api/openapi.hpp"
#include "server/app/command.hpp"
#include "server/app/running_server.hpp"

namespace tractus::app {

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
  const auto options = std::make_shared<ServeOptions>();
  command.add_flag("--plain", options->plain,
                   "HTTP without TLS, on this machine's own addresses alone: for tests and trials");
  command.add_flag("--behind-proxy", options->http.behind_proxy,
                   "HTTP without TLS: a proxy before it speaks TLS and sets X-Forwarded-For");
  const auto proxies = std::make_shared<std::vector<std::string>>();
  command.add_option("--trusted-proxy", *proxies,
                     "Address or network (ADDRESS/BITS) of a proxy whose X-Forwarded-For is "
                     "believed, with --behind-proxy; repeat it (default: this machine's own)");
  command.add_option("--host", options->hosts,
                     "Name or address that it is reached by, for its certificate; repeat it");
  command.add_flag("--log-requests", options->log_requests,
                   "A line in the log for every request, not only for those that fail");
  command.add_option(
      "--backups", options->backups,
      "Folder for backups made from the pages (default: backups in the data folder)");
  const auto lease_s = std::make_shared<double>(30.0);
  command
      .add_option("--job-lease-seconds", *lease_s,
                  "How long a job of a server that died waits before another takes it over")
      ->check(CLI::Range(0.3, 3600.0))
      ->capture_default_str();
  const auto oidc = std::make_shared<std::filesystem::path>();
  command.add_option("--oidc", *oidc,
                     "Settings of a provider of identities by which people may sign in");
  const auto pseudonyms = std::make_shared<std::filesystem::path>();
  command.add_option("--pseudonym-key", *pseudonyms,
                     "File of the key of exports' pseudonyms, made when it is not there; "
                     "DATA/pseudonyms/key if not given. No backup holds it: copy it by itself");
  const auto places = std::make_shared<std::vector<std::string>>();
  command
      .add_option("--anchors-to", *places,
                  "Where every anchor of the audit trail goes as well: the absolute path of a file "
                  "(on another disk), syslog, or an https address that takes it by POST; repeat it")
      ->type_name("PLACE");
  const auto certificate = std::make_shared<std::filesystem::path>();
  const auto key = std::make_shared<std::filesystem::path>();
  auto* chain = command.add_option("--certificate", *certificate,
                                   "PEM file of an own certificate chain, instead of the house's");
  chain->needs(command.add_option("--key", *key, "PEM file of its key"));
  return [=]() -> core::Result<int> {
    auto address = TRY(listening_address(*listen));
    options->data = common->data;
    options->json = common->json;
    for (const std::string& text : *places) {
      auto place = TRY(anchor_place(text));
      options->anchor_places.push_back(std::move(place));
    }
    if (!web->empty()) options->web = *web;
    if (!oidc->empty()) options->oidc = *oidc;
    if (!pseudonyms->empty()) options->pseudonym_key = *pseudonyms;
    if (!certificate->empty()) options->certificate.emplace(*certificate, *key);
    if (!proxies->empty()) {
      auto networks = http::Networks::parse(*proxies);
      if (!networks)
        return core::Error{networks.error().code, "--trusted-proxy " + networks.error().what};
      options->http.proxies = std::move(*networks);
    }
    options->http.address = address.first;
    options->http.port = address.second;
    options->http.header_time = std::chrono::milliseconds(std::lround(*header_s * 1000));
    options->job_lease = std::chrono::milliseconds(std::lround(*lease_s * 1000));
    TRY(serve(*options));
    return 0;
  };
}

Run openapi_command(CLI::App&) {
  return []() -> core::Result<int> {
    fmt::print("{}\n", api::openapi(api::routes()).dump(2));
    return 0;
  };
}

}  // namespace tractus::app
