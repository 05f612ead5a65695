#include "db/store/volumes/s3_request.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <chrono>
#include <random>
#include <thread>

#include "core/require.hpp"
#include "db/store/volumes/store_away.hpp"

namespace tractus {
namespace store {
namespace {

using namespace std::chrono_literals;
using core::Errc;
using core::Error;
using core::Result;

constexpr std::size_t kMostAnswer_bytes = 64u << 10;
constexpr int kMostTries = 4;
constexpr auto kPatience = 20s;  // no further try begins after it

struct CleansCurl {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreesEscaped {
  void operator()(char* text) const { curl_free(text); }
};
struct FreesLines {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

/// Why there is no answer to use, and whether the request may be repeated.
struct Trouble {
  Error error;
  bool passes = false;
};

std::string advice(const std::string& code) {
  if (code == "RequestTimeTooSkewed") return "the clocks differ: check NTP on both";
  if (code == "NoSuchBucket") return "create the bucket, or correct the address";
  if (code == "AccessDenied")
    return "give this key the rights to read, write and delete objects of the bucket";
  return "check AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, or the file of credentials, and the "
         "region";
}

Trouble refusal(const S3Answer& answer) {
  const std::string code = xml_text(answer.body, "Code");
  const bool passes = answer.status >= 500 || answer.status == 429 || answer.status == 408 ||
                      code == "RequestTimeout" || code == "OperationAborted";
  const std::string said = code.empty()
                               ? fmt::format("status {}", answer.status)
                               : fmt::format("status {}, {}", answer.status, code.substr(0, 64));
  if (passes) return {store_away(said + ": try again later"), true};
  if (answer.status == 403 || answer.status == 401 || answer.status == 404)
    return {store_away(said + ": " + advice(code))};
  return {store_away("refuses the request (" + said + ")")};
}

struct Transfer {
  const S3Request& request;
  CURL* curl;
  std::uint64_t taken_bytes = 0;  ///< by all tries together
  S3Answer answer = {};
  bool ranged = false;  ///< this try asked for a part
  bool ended = false;
};

std::size_t take_piece(char* bytes, std::size_t one, std::size_t count, void* into) {
  auto& transfer = *static_cast<Transfer*>(into);
  const std::size_t size = one * count;
  long status = 0;
  curl_easy_getinfo(transfer.curl, CURLINFO_RESPONSE_CODE, &status);
  if (transfer.request.take && status / 100 == 2) {
    // An answer with the whole object to a request for its rest would be taken for the rest.
    transfer.ended = transfer.ranged && status != 206;
    transfer.ended =
        transfer.ended || !transfer.request.take(std::as_bytes(std::span(bytes, size)));
    transfer.taken_bytes += size;
    return transfer.ended ? 0 : size;
  }
  const std::size_t room = kMostAnswer_bytes - transfer.answer.body.size();
  transfer.answer.body.append(bytes, std::min(size, room));
  return size;
}

std::string header_of(CURL* curl, const char* name) {
  curl_header* found = nullptr;
  return curl_easy_header(curl, name, 0, CURLH_HEADER, -1, &found) == CURLHE_OK ? found->value : "";
}

void read_head(Transfer& transfer) {
  curl_off_t length = 0;
  curl_easy_getinfo(transfer.curl, CURLINFO_RESPONSE_CODE, &transfer.answer.status);
  curl_easy_getinfo(transfer.curl, CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &length);
  transfer.answer.length_bytes = static_cast<std::uint64_t>(std::max<curl_off_t>(length, 0));
  transfer.answer.etag = header_of(transfer.curl, "ETag");
}

std::optional<Trouble> try_once(Transfer& transfer) {
  transfer.answer = {};
  const S3Request& request = transfer.request;
  const std::uint64_t first = request.from + transfer.taken_bytes;
  const std::string range = request.size
                                ? fmt::format("{}-{}", first, request.from + *request.size - 1)
                                : fmt::format("{}-", first);
  transfer.ranged = first > 0 || request.size;
  if (transfer.ranged) curl_easy_setopt(transfer.curl, CURLOPT_RANGE, range.c_str());
  const CURLcode code = curl_easy_perform(transfer.curl);
  if (transfer.ended) return Trouble{{Errc::cancelled, "object store: the transfer was ended"}};
  if (code != CURLE_OK)
    return Trouble{store_away(fmt::format("does not answer: {}", curl_easy_strerror(code))), true};
  read_head(transfer);
  const S3Answer& answer = transfer.answer;
  const bool absent = answer.status == 404 && xml_text(answer.body, "Code") != "NoSuchBucket";
  if (answer.status / 100 == 2 || absent) return std::nullopt;
  return refusal(answer);
}

/// Random, so that servers which met the same trouble do not come back together.
std::chrono::milliseconds pause_after(int tries) {
  thread_local std::minstd_rand random(std::random_device{}());
  const int whole_ms = 100 << (2 * (tries - 1));  // 100, 400, 1600 ms
  return std::chrono::milliseconds(std::uniform_int_distribution(whole_ms / 2, whole_ms)(random));
}

}  // namespace

struct S3Client::Handle {
  std::unique_ptr<CURL, CleansCurl> curl{curl_easy_init()};
  std::unique_ptr<curl_slist, FreesLines> lines = {};
};

S3Client::S3Client(S3Address address, S3Credentials credentials)
    : address_(std::move(address)), credentials_(std::move(credentials)) {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
}

S3Client::~S3Client() = default;

std::unique_ptr<S3Client::Handle> S3Client::idle_handle() const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto out = std::move(idle_.back());
      idle_.pop_back();
      return out;
    }
  }
  auto out = std::make_unique<Handle>();
  core::require(out->curl != nullptr, "memory for a transfer");
  return out;
}

/// libcurl signs each line of the list; it would sign "Expect:" too, which is not sent, so that no
/// header is taken away here.
void S3Client::set_headers(Handle& handle, const S3Request& request) const {
  std::vector<std::string> texts{"x-amz-content-sha256: " + request.sha256};
  if (!request.body.empty()) texts.emplace_back("Content-Type: application/octet-stream");
  if (!credentials_.session_token.empty())
    texts.push_back("x-amz-security-token: " + credentials_.session_token);
  curl_slist* lines = nullptr;
  for (const std::string& text : texts) lines = curl_slist_append(lines, text.c_str());
  handle.lines.reset(lines);
  curl_easy_setopt(handle.curl.get(), CURLOPT_HTTPHEADER, lines);
}

void S3Client::set_request(Handle& handle, const S3Request& request) const {
  CURL* curl = handle.curl.get();
  const std::string_view method = request.method;
  curl_easy_reset(curl);
  set_headers(handle, request);
  curl_easy_setopt(curl, CURLOPT_URL, (address_.url + request.path).c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_AWS_SIGV4, ("aws:amz:" + address_.region + ":s3").c_str());
  curl_easy_setopt(curl, CURLOPT_USERNAME, credentials_.key_id.c_str());
  curl_easy_setopt(curl, CURLOPT_PASSWORD, credentials_.secret.c_str());
  curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, 3L);
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1024L);
  curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, request.slow ? 120L : 10L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_piece);
  curl_easy_setopt(curl, CURLOPT_CUSTOMREQUEST, request.method);
  if (method == "HEAD") curl_easy_setopt(curl, CURLOPT_NOBODY, 1L);
  if (method == "PUT" || method == "POST") {
    const auto body = core::text_of(request.body);
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body.empty() ? "" : body.data());
  }
}

Result<S3Answer> S3Client::ask(const S3Request& request) const {
  auto handle = idle_handle();
  set_request(*handle, request);
  Transfer transfer{request, handle->curl.get()};
  curl_easy_setopt(transfer.curl, CURLOPT_WRITEDATA, &transfer);
  const auto until = std::chrono::steady_clock::now() + kPatience;
  for (int tries = 1;; ++tries) {
    const auto trouble = try_once(transfer);
    if (!trouble) break;
    if (!trouble->passes || tries == kMostTries || std::chrono::steady_clock::now() > until)
      return trouble->error;
    std::this_thread::sleep_for(pause_after(tries));
  }
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(handle));
  return std::move(transfer.answer);
}

std::string percent_encoded(const std::string& text) {
  if (text.empty()) return {};  // to libcurl, no length is that of a C string
  const std::unique_ptr<char, FreesEscaped> out(
      curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size())));
  core::require(out != nullptr, "memory for an address");
  return out.get();
}

std::string xml_text(const std::string& document, const std::string& element) {
  const std::string opening = "<" + element + ">";
  const auto from = document.find(opening);
  if (from == std::string::npos) return {};
  const auto first = from + opening.size();
  const auto end = document.find('<', first);
  return end == std::string::npos ? "" : document.substr(first, end - first);
}

}  // namespace store
}  // namespace tractus
