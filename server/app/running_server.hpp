/// The running server.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/app/anchoring.hpp"
#include "server/http/server.hpp"

namespace tractus::app {

struct ServeOptions {
  std::filesystem::path data;
  std::optional<std::filesystem::path> web;  ///< built pages; none: the API alone
  http::ServerOptions http;
  std::optional<std::filesystem::path> backups = {};  ///< else a folder of the data
  bool plain = false;              ///< no TLS, on this machine's own addresses alone
  std::vector<std::string> hosts;  ///< names and addresses the certificate must hold
  /// PEM files of an own certificate chain and its key, instead of the house's.
  std::optional<std::pair<std::filesystem::path, std::filesystem::path>> certificate;
  std::chrono::milliseconds job_lease{30'000};  ///< see jobs::Runner
  std::uint64_t objects_cache_bytes = 0;        ///< see store::Objects::limit_cache
  std::optional<std::filesystem::path> oidc;    ///< settings of a provider of identities
  std::optional<std::filesystem::path> mail;    ///< settings of the mail server
  std::optional<std::filesystem::path> pacs;    ///< settings of the PACS
  http::Networks webhook_networks = {};         ///< private networks whose webhooks are called
  /// The key of exports' pseudonyms; none: DATA/pseudonyms/key.
  std::optional<std::filesystem::path> pseudonym_key;
  std::vector<AnchorPlace> anchor_places = {};  ///< where anchors of the audit trail go as well
  bool log_requests = false;  ///< a line for every one, not only for those that fail
  bool json = false;          ///< the line that says where it listens
};

/// Splits "127.0.0.1:8480" or "[::1]:8480". Errors: bad_input.
core::Result<std::pair<std::string, std::uint16_t>> listening_address(const std::string& text);

/// Serves until SIGTERM or SIGINT. Prints one line, "listening on https://…", once it answers.
/// Errors: bad_input for plain HTTP on an address that others reach.
core::Result<void> serve(const ServeOptions& options);

}  // namespace tractus::app
