/// This server as a tool of learning platforms: its addresses, and what it may call.
#pragma once

#include <string>

#include "server/api/backend.hpp"
#include "server/http/networks.hpp"

namespace tractus::api {

/// What an administrator enters at the platform.
struct ToolAddresses {
  std::string login, launch, keys;
};
ToolAddresses tool_addresses(const Backend& backend);

/// "https://host:8480": how browsers reach this server; empty if nothing states it.
std::string public_base(const Backend& backend);
/// Private networks to which requests may be sent (--webhook-network).
http::Networks outside_networks(const Backend& backend);

}  // namespace tractus::api
