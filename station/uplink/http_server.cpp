#include "station/uplink/http_server.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace tractus {
namespace uplink {
namespace {
constexpr long kConnect_s = 5, kStall_s = 30, kAll_s = 120;

struct Received {
  core::Bytes bytes;
  std::uint64_t limit = 0;
  bool too_large = false;
};

std::size_t take(char* data, std::size_t one, std::size_t count, void* into) {
  auto& received = *static_cast<Received*>(into);
  const std::size_t size = one * count;
  if (received.bytes.size() + size > received.limit) {
    received.too_large = true;
    return 0;
  }
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  received.bytes.insert(received.bytes.end(), bytes, bytes + size);
  return size;
}

/// Once in a process, before any thread uses it.
bool curl_ready() {
  static const bool ready = curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
  return ready;
}
}  // namespace

struct HttpServer::Connection {
  CURL* handle = nullptr;
  curl_slist* headers = nullptr;
  std::string url, bearer;
  std::filesystem::path authority;
  char failure[CURL_ERROR_SIZE] = {};

  ~Connection() {
    curl_slist_free_all(headers);
    if (handle) curl_easy_cleanup(handle);
  }
  void add(const std::string& line) {
    if (curl_slist* longer = curl_slist_append(headers, line.c_str())) headers = longer;
  }
  void prepare(const Request& request, Received& into);
};

HttpServer::HttpServer(std::unique_ptr<Connection> connection)
    : connection_(std::move(connection)) {}
HttpServer::~HttpServer() = default;

core::Result<std::unique_ptr<HttpServer>> HttpServer::make_nameless(
    const std::string& url, const std::filesystem::path& authority) {
  std::string base = url;
  while (base.ends_with('/')) base.pop_back();
  const std::size_t scheme = base.starts_with("http://") ? 7 : base.starts_with("https://") ? 8 : 0;
  if (scheme == 0 || base.size() == scheme ||
      base.find_first_of("/?#@ \t\r\n", scheme) != std::string::npos)
    return core::Error{
        core::Errc::bad_input,
        fmt::format("--server {}: http://HOST:PORT or https://HOST:PORT is expected", url)};
  std::error_code failure;
  if (!authority.empty() && !std::filesystem::is_regular_file(authority, failure))
    return core::Error{core::Errc::not_found, authority.string() + ": no such file"};
  auto connection = std::make_unique<Connection>();
  connection->handle = curl_ready() ? curl_easy_init() : nullptr;
  if (!connection->handle) return core::Error{core::Errc::unavailable, "libcurl does not start"};
  connection->url = base;
  connection->authority = authority;
  return std::unique_ptr<HttpServer>(new HttpServer(std::move(connection)));
}

core::Result<std::unique_ptr<HttpServer>> HttpServer::make(const std::string& url,
                                                           const std::string& token,
                                                           const std::filesystem::path& authority) {
  if (token.empty() || token.size() > 4096 ||
      !std::ranges::all_of(token, [](unsigned char c) { return std::isgraph(c); }))
    return core::Error{core::Errc::bad_input,
                       "the station's token is empty or holds odd characters"};
  auto made = make_nameless(url, authority);
  if (made) (*made)->connection_->bearer = "Authorization: Bearer " + token;
  return made;
}

void HttpServer::Connection::prepare(const Request& request, Received& into) {
  curl_easy_reset(handle);
  curl_slist_free_all(headers);
  headers = nullptr;
  if (!bearer.empty()) add(bearer);
  add("Expect:");
  for (const auto& [name, value] : request.headers) add(name + ": " + value);
  curl_easy_setopt(handle, CURLOPT_URL, (url + request.path).c_str());
  curl_easy_setopt(handle, CURLOPT_CUSTOMREQUEST, request.method.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(handle, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(handle, CURLOPT_SSLVERSION, CURL_SSLVERSION_TLSv1_2);
  if (!authority.empty()) {
    curl_easy_setopt(handle, CURLOPT_CAINFO, authority.c_str());
    curl_easy_setopt(handle, CURLOPT_CAPATH, nullptr);
  }
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT, kConnect_s);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, kStall_s);
  curl_easy_setopt(handle, CURLOPT_TIMEOUT, kAll_s);
  curl_easy_setopt(handle, CURLOPT_ERRORBUFFER, failure);
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, take);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, &into);
  if (request.method == "PUT" || request.method == "PATCH" || request.method == "POST") {
    curl_easy_setopt(handle, CURLOPT_POSTFIELDSIZE_LARGE,
                     static_cast<curl_off_t>(request.body.size()));
    curl_easy_setopt(
        handle, CURLOPT_POSTFIELDS,
        request.body.empty() ? "" : reinterpret_cast<const char*>(request.body.data()));
  }
  curl_easy_setopt(handle, CURLOPT_HTTPHEADER, headers);
  failure[0] = 0;
}

core::Result<HttpResponse> HttpServer::send(const Request& request) {
  Received received{.bytes = {}, .limit = request.max_answer_bytes};
  connection_->prepare(request, received);
  const CURLcode code = curl_easy_perform(connection_->handle);
  if (received.too_large)
    return core::Error{core::Errc::too_large,
                       fmt::format("{} {}: the answer is over {} bytes", request.method,
                                   request.path, request.max_answer_bytes)};
  if (code != CURLE_OK)
    return core::Error{
        core::Errc::unavailable,
        fmt::format("{} does not answer: {}", connection_->url,
                    connection_->failure[0] ? connection_->failure : curl_easy_strerror(code))};
  long status = 0;
  curl_easy_getinfo(connection_->handle, CURLINFO_RESPONSE_CODE, &status);
  if (status / 100 == 3)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{} {}: the server redirects; redirects are refused",
                                   request.method, request.path)};
  return HttpResponse{static_cast<int>(status), std::move(received.bytes)};
}

}  // namespace uplink
}  // namespace tractus
