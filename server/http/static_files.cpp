#include "server/http/static_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tractus {
namespace http {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 15> kTypes{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".woff", "font/woff"},
    {".wasm", "application/wasm"},
    {".txt", "text/plain; charset=utf-8"},
    {".webmanifest", "application/manifest+json"},
}};

std::string type_of(const fs::path& path) {
  const std::string extension = path.extension().string();
  const auto found =
      std::ranges::find(kTypes, extension, [](const auto& type) { return type.first; });
  return std::string(found == kTypes.end() ? "application/octet-stream" : found->second);
}

Response plain(int status, std::string text) {
  Response response{.status = status, .headers = {}, .body = std::move(text)};
  return response.with("Content-Type", "text/plain; charset=utf-8"), response;
}

/// The path as names under the folder; nothing when one of them could lead elsewhere.
std::optional<fs::path> inside(std::string_view escaped) {
  fs::path out;
  while (!escaped.empty()) {
    escaped.remove_prefix(1);  // '/'
    const auto end = std::min(escaped.find('/'), escaped.size());
    auto name = percent_decoded(escaped.substr(0, end));
    if (!name || name->find_first_of("/\\") != std::string::npos) return std::nullopt;
    if (!name->empty() && name->front() == '.') return std::nullopt;
    if (!name->empty()) out /= *name;
    escaped.remove_prefix(end);
  }
  return out;
}

/// Does it lie in the folder after links are followed?
bool lies_in(const fs::path& folder, const fs::path& file) {
  std::error_code failure;
  const fs::path real_folder = fs::canonical(folder, failure);
  if (failure) return false;
  const fs::path real_file = fs::canonical(file, failure);
  if (failure) return false;
  const auto [end, _] = std::ranges::mismatch(real_folder, real_file);
  return end == real_folder.end() && fs::is_regular_file(real_file, failure);
}

/// Size and time of change: another build has another one.
std::string entity_tag(const fs::path& file) {
  std::error_code ignored;
  const auto changed = fs::last_write_time(file, ignored).time_since_epoch().count();
  return fmt::format("\"{:x}-{:x}\"", fs::file_size(file, ignored), changed);
}

}  // namespace

Response StaticFiles::answer(const RequestHead& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    Response refusal = plain(405, "pages accept only GET and HEAD\n");
    return refusal.with("Allow", "GET, HEAD"), refusal;
  }
  const auto relative = inside(request.path);
  if (!relative) return plain(404, "no such page\n");
  const bool own_path = relative->extension().empty();
  const fs::path file = folder_ / (own_path ? fs::path("index.html") : *relative);
  if (!lies_in(folder_, file)) return plain(404, "no such page\n");
  const std::string tag = entity_tag(file);
  const bool hashed = !own_path && relative->begin()->string() == "assets";
  const std::string kept = hashed ? "public, max-age=31536000, immutable" : "no-cache";
  if (request.header("if-none-match") == tag) {
    Response unchanged{.status = 304, .headers = {}, .body = std::string()};
    return unchanged.with("ETag", tag).with("Cache-Control", kept), unchanged;
  }
  auto response = file_response(file, request, type_of(file));
  if (!response) return plain(404, "no such page\n");
  response->with("ETag", tag).with("Cache-Control", kept);
  return std::move(*response);
}

void require_tls(Response& response) {
  response.with("Strict-Transport-Security", "max-age=31536000");
}

void add_security_headers(Response& response) {
  if (response.header("Cache-Control").empty()) response.with("Cache-Control", "no-store");
  response
      .with("Content-Security-Policy",
            "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:; "
            "style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; connect-src 'self'; "
            "object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'")
      .with("X-Content-Type-Options", "nosniff")
      .with("X-Frame-Options", "DENY")
      .with("Referrer-Policy", "no-referrer")
      .with("Cross-Origin-Opener-Policy", "same-origin")
      .with("Cross-Origin-Resource-Policy", "same-origin");
}

}  // namespace http
}  // namespace tractus
