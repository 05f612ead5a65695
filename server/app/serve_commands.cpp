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
  command
      .add_option("--listen", *listen,
                  "Address and port to listen on, ADDRESS:PORT; port 0: a free port is chosen")
      ->capture_default_str();
  command.add_option(
      "--web", *web,
      "Folder of the built web pages; if it is missing, the server offers only the API");
  command
      .add_option("--header-seconds", *header_s,
                  "Largest time for receiving the head of a request, in seconds")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  const auto options = std::make_shared<ServeOptions>();
  command.add_flag(
      "--plain", options->plain,
      "HTTP without TLS, only on loopback addresses of this machine: for tests and demonstrations");
  command.add_flag("--behind-proxy", options->http.behind_proxy,
                   "HTTP without TLS behind a reverse proxy, which does TLS and sets the header "
                   "X-Forwarded-For");
  const auto proxies = std::make_shared<std::vector<std::string>>();
  command.add_option(
      "--trusted-proxy", *proxies,
      "Address or network (ADDRESS/BITS) of a proxy whose header X-Forwarded-For the server "
      "trusts, with --behind-proxy; may be repeated (default: loopback addresses)");
  command.add_option("--host", options->hosts,
                     "Host name or address under which clients reach the server, for its "
                     "certificate; may be repeated");
  command.add_flag("--log-requests", options->log_requests,
                   "Log every request, not only failed ones");
  command.add_option("--backups", options->backups,
                     "Folder for backups that people make on the web pages (default: folder "
                     "backups in the data folder)");
  const auto connections = std::make_shared<int>(4096);
  command
      .add_option("--max-connections", *connections,
                  "Largest number of open connections; WebSockets, such as the live connections of "
                  "stations and pages, get at most seven eighths of them")
      ->check(CLI::Range(16, 100'000))
      ->capture_default_str();
  const auto lease_s = std::make_shared<double>(30.0);
  command
      .add_option("--job-lease-seconds", *lease_s,
                  "Lease of a job, in seconds: after this time another server takes over the job "
                  "of a server that died")
      ->check(CLI::Range(0.3, 3600.0))
      ->capture_default_str();
  const auto cache_GiB = std::make_shared<double>(50.0);
  command
      .add_option(
          "--objects-cache-GiB", *cache_GiB,
          "Size of the cache in the data folder of objects that are kept in an S3 bucket, in "
          "GiB; what was used within the last hour stays")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  const auto oidc = std::make_shared<std::filesystem::path>();
  command.add_option("--oidc", *oidc,
                     "Settings file of an OpenID Connect provider with which people can sign in");
  const auto mail = std::make_shared<std::filesystem::path>();
  command.add_option("--mail", *mail,
                     "Settings file of the mail server by which people are told of events");
  const auto pacs = std::make_shared<std::filesystem::path>();
  command.add_option("--pacs", *pacs,
                     "Settings file of a PACS from which people import volumes (DICOMweb)");
  const auto webhook_networks = std::make_shared<std::vector<std::string>>();
  command.add_option("--webhook-network", *webhook_networks,
                     "Private address or network (ADDRESS/BITS) whose webhooks, learning platforms "
                     "and record stores the server "
                     "calls; may be repeated "
                     "(default: only public addresses)");
  const auto pseudonyms = std::make_shared<std::filesystem::path>();
  command.add_option(
      "--pseudonym-key", *pseudonyms,
      "File with the key of the pseudonyms in exports; it is created if it does not exist "
      "(default: DATA/pseudonyms/key). Backups do not contain this key: copy it separately");
  const auto places = std::make_shared<std::vector<std::string>>();
  command
      .add_option(
          "--anchors-to", *places,
          "Additional place for every anchor of the audit trail: the absolute path of a file (on "
          "another disk), syslog, or an https address that accepts POST; may be repeated")
      ->type_name("PLACE");
  const auto certificate = std::make_shared<std::filesystem::path>();
  const auto key = std::make_shared<std::filesystem::path>();
  auto* chain = command.add_option(
      "--certificate", *certificate,
      "PEM file of a certificate chain, instead of the certificate that the server makes");
  chain->needs(command.add_option("--key", *key, "PEM file of the certificate's private key"));
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
    if (!mail->empty()) options->mail = *mail;
    if (!pacs->empty()) options->pacs = *pacs;
    if (!webhook_networks->empty()) {
      auto networks = http::Networks::parse(*webhook_networks);
      if (!networks)
        return core::Error{networks.error().code, "--webhook-network " + networks.error().what};
      options->webhook_networks = std::move(*networks);
    }
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
    options->http.max_connections = *connections;
    options->http.header_time = std::chrono::milliseconds(std::lround(*header_s * 1000));
    options->objects_cache_bytes = static_cast<std::uint64_t>(*cache_GiB * double(1u << 30));
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
