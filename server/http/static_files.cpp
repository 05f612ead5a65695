#include "server/http/static_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/trim.hpp"

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

/// A coding that the web build stores beside a file, best first.
struct Coding {
  std::string_view name, extension;
};
constexpr std::array<Coding, 2> kCodings{{{"br", ".br"}, {"gzip", ".gz"}}};

/// Does an Accept-Encoding header name the coding, with a weight above 0 (RFC 9110, section 12.5.3)?
/// "*" is not taken as consent: a client that reads a coding names it.
bool accepts(std::string_view header, std::string_view coding) {
  while (!header.empty()) {
    const std::string_view item = header.substr(0, header.find(','));
    header.remove_prefix(std::min(header.size(), item.size() + 1));
    const std::string_view name = core::trimmed(item.substr(0, item.find(';')));
    if (name != coding) continue;
    const auto weight = item.find("q=");
    return weight == std::string_view::npos ||
           item.find_first_of("123456789", weight) != std::string_view::npos;
  }
  return false;
}

/// Size and time of change: another build has another one, and so has each coding of a file.
std::string entity_tag(const fs::path& file, std::string_view coding) {
  std::error_code ignored;
  const auto changed = fs::last_write_time(file, ignored).time_since_epoch().count();
  return fmt::format("\"{:x}-{:x}{}{}\"", fs::file_size(file, ignored), changed,
                     coding.empty() ? "" : "-", coding);
}

/// The file that is sent for a file of the folder: itself, or a compressed copy beside it.
struct Sent {
  fs::path file;
  std::string_view coding = {};  ///< empty: the file itself
  bool varies = false;           ///< another client may get another coding
};

Sent sent_for(const fs::path& folder, const fs::path& file, std::string_view accepted) {
  Sent out{file};
  for (const auto& [name, extension] : kCodings) {
    const fs::path copy = fs::path(file) += extension;
    if (!lies_in(folder, copy)) continue;
    out.varies = true;
    if (out.coding.empty() && accepts(accepted, name)) out.file = copy, out.coding = name;
  }
  return out;
}

/// The headers that both the file and the answer "unchanged" have.
void describe(Response& response, const Sent& sent, const std::string& tag, bool hashed) {
  response.with("ETag", tag)
      .with("Cache-Control", hashed ? "public, max-age=31536000, immutable" : "no-cache");
  if (sent.varies) response.with("Vary", "Accept-Encoding");
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
  const bool hashed = !own_path && relative->begin()->string() == "assets";
  const Sent sent = sent_for(folder_, file, request.header("accept-encoding"));
  const std::string tag = entity_tag(sent.file, sent.coding);
  if (request.header("if-none-match") == tag) {
    Response unchanged{.status = 304, .headers = {}, .body = std::string()};
    return describe(unchanged, sent, tag, hashed), unchanged;
  }
  auto response = file_response(sent.file, request, type_of(file));
  if (!response) return plain(404, "no such page\n");
  describe(*response, sent, tag, hashed);
  if (!sent.coding.empty()) response->with("Content-Encoding", std::string(sent.coding));
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
