#include "server/app/running_server.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <thread>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/people/consent.hpp"
#include "server/api/backend.hpp"
#include "server/api/operations/notifier.hpp"
#include "server/api/people/oidc.hpp"
#include "server/api/refusals.hpp"
#include "server/api/service.hpp"
#include "server/api/trials/uploads.hpp"
#include "server/api/volumes/pacs_imports.hpp"
#include "server/app/anchoring.hpp"
#include "server/app/backups.hpp"
#include "server/app/descriptors.hpp"
#include "server/app/freed_memory.hpp"
#include "server/app/import_process.hpp"
#include "server/app/leaving.hpp"
#include "server/app/log.hpp"
#include "server/http/certificates.hpp"
#include "server/http/static_files.hpp"
#include "server/jobs/runner.hpp"
#include "server/live/hub.hpp"
#include "tracing/tracer.hpp"

namespace tractus {
namespace app {
namespace {

/// SIGTERM and SIGINT are kept from every thread (call before any starts) and taken by one that
/// waits for them.
class StopSignals {
 public:
  StopSignals() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGTERM);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGUSR1);  // our own, to end the waiting
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    signal(SIGPIPE, SIG_IGN);
  }
  void watch(http::Server& server) {
    thread_ = std::thread([this, &server] {
      int which = 0;
      sigwait(&signals_, &which);
      server.stop();
    });
  }
  ~StopSignals() {
    if (!thread_.joinable()) return;
    pthread_kill(thread_.native_handle(), SIGUSR1);
    thread_.join();
  }
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  sigset_t signals_;
  std::thread thread_;
};

http::Service service_of(api::Backend& backend, FreedMemory& memory,
                         const std::optional<std::filesystem::path>& web) {
  const auto is_api = [](const http::RequestHead& head) {
    return head.path == "/api" || head.path.starts_with("/api/");
  };
  const auto pages = [web](const http::RequestHead& head) {
    if (web) return http::StaticFiles(*web).answer(head);
    return http::error_response(
        404, "not_found", "this server has no web pages; /api/openapi.json describes its API");
  };
  return {
      .admit = [&backend, is_api](
                   const http::RequestHead& head) -> std::variant<http::Admitted, http::Response> {
        if (is_api(head)) return api::admit(backend, api::routes(), head);
        return http::error_response(405, "bad_input", "requests for pages must not have a body");
      },
      .handle =
          [&backend, &memory, is_api, pages](const http::Request& request) {
            memory.note_request();
            if (!is_api(request)) return pages(request);
            return api::answer(backend, api::routes(), request);
          },
      .converse =
          [&backend](const http::RequestHead& head) {
            return api::converse(backend, api::routes(), head);
          },
      .lane = [](const http::RequestHead& head) { return api::lane_of(api::routes(), head); },
      .standing =
          [&backend](const http::RequestHead& head) {
            return api::standing(backend, api::routes(), head);
          }};
}

std::string address_of(const ServeOptions& options, std::uint16_t port) {
  const bool six = options.http.address.find(':') != std::string::npos;
  const std::string address = six ? "[" + options.http.address + "]" : options.http.address;
  return fmt::format("{}://{}:{}", options.http.tls ? "https" : "http", address, port);
}

void say_where(const ServeOptions& options, std::uint16_t port) {
  const std::string url = address_of(options, port) + "/";
  if (options.json)
    fmt::print("{}\n", core::Json{{"listening", url}}.dump());
  else
    fmt::print("listening on {}\n", url);
  std::fflush(stdout);
}

}  // namespace

core::Result<std::pair<std::string, std::uint16_t>> listening_address(const std::string& text) {
  const core::Error wrong{
      core::Errc::bad_input,
      fmt::format("--listen {}: ADDRESS:PORT is expected, for example 127.0.0.1:8480", text)};
  const auto colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return wrong;
  std::string address = text.substr(0, colon);
  if (address.front() == '[' && address.back() == ']')
    address = address.substr(1, address.size() - 2);
  std::uint16_t port = 0;
  const char* end = text.data() + text.size();
  const auto [stopped, failure] = std::from_chars(text.data() + colon + 1, end, port);
  if (failure != std::errc() || stopped != end) return wrong;
  return std::pair(address, port);
}

namespace {

bool is_loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

/// With the certificate to serve by, unless it goes plain.
core::Result<ServeOptions> secured(ServeOptions options) {
  if (options.http.behind_proxy) return options;
  if (options.plain) {
    if (is_loopback(options.http.address)) return options;
    return core::Error{
        core::Errc::bad_input,
        fmt::format("--plain: other machines can reach {}; passwords and trials would be sent "
                    "without encryption. Leave --plain out, or use --behind-proxy",
                    options.http.address)};
  }
  if (options.certificate) {
    options.http.tls = options.certificate;
    return options;
  }
  const auto folder = options.data / kCertificates;
  auto names = http::own_names();
  names.insert(names.end(), options.hosts.begin(), options.hosts.end());
  TRY(http::ensure_certificates(folder, names, core::utc_us() / 1'000'000));
  const auto files = http::certificate_files(folder);
  options.http.tls.emplace(files.certificate, files.key);
  return options;
}

}  // namespace

namespace {

/// Where this process puts large bodies, answers and temporary files: a folder of its own below
/// DATA/scratch.
struct Scratch {
  std::filesystem::path path;
  ServingLock lock;  ///< held as long as the process lives
};

/// Takes a new folder and removes those of processes that died: what they left may hold a patient's
/// scan.
core::Result<Scratch> own_scratch(const std::filesystem::path& data) {
  const std::filesystem::path all = data / "scratch", own = all / core::new_id();
  std::error_code failure;
  std::filesystem::create_directories(all, failure);
  for (const auto& left : std::filesystem::directory_iterator(all, failure))
    if (ServingLock::take(left.path(), false)) std::filesystem::remove_all(left.path(), failure);
  if (!failure) std::filesystem::create_directory(own, failure);
  if (!failure) std::filesystem::permissions(own, std::filesystem::perms::owner_all, failure);
  if (failure)
    return core::Error{core::Errc::io, own.string() + ": cannot be made: " + failure.message()};
  auto lock = TRY(ServingLock::take(own, false));
  return Scratch{own, std::move(lock)};
}

std::string fingerprint_of(const api::Secrets::Key& key) {
  return core::sha256(core::bytes_of("key of pseudonyms " + core::hex(key))).substr(0, 32);
}

/// The key of pseudonyms, made where there never was one. Where the one that was is not there,
/// nothing is exported, and the log says so: another key would give everybody another name.
core::Result<std::optional<api::Secrets::Key>> pseudonym_key_of(const std::filesystem::path& path,
                                                                store::Store& store) {
  using Maybe = std::optional<api::Secrets::Key>;
  auto known = TRY(store.read([](store::Reading& tx) { return store::pseudonym_key_known(tx); }));
  std::error_code failure;
  const bool there = std::filesystem::exists(path, failure);
  if (!there && !known.empty()) {
    log_line({{"what", "the key of pseudonyms is missing: exports are not possible"}});
    return Maybe();
  }
  if (!there) {
    std::filesystem::create_directories(path.parent_path(), failure);
    TRY(make_key_file(path));
  }
  auto key = TRY(read_key_file(path));
  if (known.empty()) {
    TRY(store.write([&](store::Writing& tx) {
      return store::note_pseudonym_key(tx, fingerprint_of(key), core::utc_us());
    }));
  } else if (known != fingerprint_of(key)) {
    log_line({{"what",
               "the key of pseudonyms differs from the key of earlier exports: exports are not "
               "possible"}});
    return Maybe();
  }
  return Maybe(key);
}

/// Those who chose it are told.
void note_failed_backup(store::Store& store, const api::Backup& backup) {
  const auto noted = store.write([&](store::Writing& tx) {
    return store::note_event(tx,
                             {.id = {},
                              .kind = store::NotificationKind::backup_failed,
                              .key = fmt::format("backup/{}/{}", backup.id, backup.verified_utc_us),
                              .subject = backup.id,
                              .at_utc_us = core::utc_us()});
  });
  if (!noted) log_line({{"what", "a failed backup was not noted for those who are told"}});
}

}  // namespace

core::Result<void> serve(const ServeOptions& given) {
  StopSignals signals;
  auto data = TRY(open_data(given.data));
  auto lock = TRY(ServingLock::take(given.data, data.store.shared()));
  data.objects.limit_cache(given.objects_cache_bytes);
  const auto secure = TRY(secured(given));
  remove_left_overs(given.data, !data.store.shared());
  const auto scratch = TRY(own_scratch(given.data));
  ::setenv("TMPDIR", scratch.path.c_str(), 1);  // temporary files of every part of this program
  const auto space = std::make_shared<http::ScratchSpace>(scratch.path);
  ServeOptions options = secure;
  options.http.scratch = space.get();
  options.http.max_connections = connections_within_limit(options.http.max_connections);
  if (options.web && !std::filesystem::is_regular_file(*options.web / "index.html"))
    return core::Error{
        core::Errc::not_found,
        options.web->string() + ": the folder has no index.html; build the web pages first"};
  std::optional<api::OidcSettings> oidc_settings;
  if (options.oidc) {
    auto settings = TRY(api::read_oidc_settings(*options.oidc));
    oidc_settings = std::move(settings);
  }
  std::optional<api::PacsSettings> pacs_settings;
  if (options.pacs) pacs_settings = TRY(api::read_pacs_settings(*options.pacs));
  api::NotifierSettings told{.networks = options.webhook_networks};
  if (options.mail) told.mail = TRY(api::read_mail_settings(*options.mail));
  const auto pseudonym_key = TRY(pseudonym_key_of(
      options.pseudonym_key.value_or(given.data / "pseudonyms" / "key"), data.store));
  const auto tracer =
      tracing::tracer_of_environment("tractus-server", TRACTUS_VERSION, [](const std::string& why) {
        core::Json line{{"what", "traces"}};
        if (!why.empty()) line["error"] = why;
        log_line(line);
      });
  auto runner = jobs::Runner::start(
      data.store, data.objects, {data.secrets.case_key(), pseudonym_key},
      [](const std::string& line) {
        log_line({{"what", "job"}, {"line", line}});
      },
      options.job_lease, tracer.get());
  if (!runner) return runner.error();
  BackupFolder backups(given.data, given.backups.value_or(given.data / "backups"));
  TRY(backups.tidy(!data.store.shared()));
  backups.on_failure(
      [&store = data.store](const api::Backup& backup) { note_failed_backup(store, backup); });
  std::atomic<Leaving*> leaving = nullptr;  // none before the trail is begun
  api::Backend backend{.store = data.store,
                       .objects = data.objects,
                       .partials = data.partials,
                       .now_utc_us = core::utc_us,
                       .work_waits =
                           [&runner, &leaving] {
                             (*runner)->wake();
                             if (Leaving* one = leaving) one->wake();
                           },
                       .secrets = data.secrets,
                       .secure_cookies = options.http.tls || options.http.behind_proxy,
                       .log = log_line,
                       .logs_requests = options.log_requests,
                       .backups = &backups,
                       .import_volume = import_volume_in_subprocess,
                       .scratch = space,
                       .pseudonym_key = pseudonym_key,
                       .tracer = tracer.get()};
  live::Hub hub({.store = data.store,
                 .now_utc_us = core::utc_us,
                 .refused =
                     [&backend](const live::StationRef& station, const std::string& why) {
                       const api::Caller caller{api::Role::station, station.id, station.name, ""};
                       api::note_refusal(backend, caller, "", "liveStation", "", why);
                     },
                 .log = log_line});
  backend.live = &hub;
  TRY(begin_trail(data));
  TRY(api::reconcile_uploads(backend));
  TRY(hub.start());
  FreedMemory memory;
  auto server = TRY(http::Server::open(options.http, service_of(backend, memory, options.web)));
  std::optional<api::Oidc> oidc;
  if (oidc_settings) {
    if (oidc_settings->base.empty()) oidc_settings->base = address_of(options, server.port());
    backend.oidc = &oidc.emplace(std::move(*oidc_settings));
  }
  std::optional<api::PacsImports> pacs;
  if (pacs_settings) backend.pacs = &pacs.emplace(backend, std::move(*pacs_settings));
  told.base = told.mail      ? told.mail->base
              : backend.oidc ? backend.oidc->settings().base
                             : address_of(options, server.port());
  api::Notifier notifier(backend, std::move(told));
  backend.notifier = &notifier;
  notifier.start();
  signals.watch(server);
  say_where(options, server.port());
  {
    const Anchoring anchoring(data, options.anchor_places);
    Leaving people(
        data,
        {given.data / kErasureList, given.backups.value_or(given.data / "backups") / kErasureList},
        [&backend] { backend.held_cohorts.forget(); });
    leaving = &people;
    log_line({{"what", "serving"}, {"tls", options.http.tls.has_value()}});
    server.run();
    leaving = nullptr;
    backend.pacs = nullptr;
    pacs.reset();
    (*runner)->end();  // what an import or a job writes at last is anchored too
  }
  log_line({{"what", "stopped"}});
  return {};
}

}  // namespace app
}  // namespace tractus
