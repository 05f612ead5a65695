#include "server/api/learning/tool.hpp"

#include "server/api/operations/notifier.hpp"

namespace tractus::api {

std::string public_base(const Backend& backend) {
  return backend.notifier ? backend.notifier->settings().base : std::string();
}

http::Networks outside_networks(const Backend& backend) {
  return backend.notifier ? backend.notifier->settings().networks : http::Networks();
}

ToolAddresses tool_addresses(const Backend& backend) {
  const std::string path = public_base(backend) + "/api/v1/lti";
  return {path + "/login", path + "/launch", path + "/keys"};
}

}  // namespace tractus::api
