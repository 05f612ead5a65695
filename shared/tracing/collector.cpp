#include "tracing/collector.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <memory>

#include "tracing/otlp.hpp"

namespace tractus {
namespace tracing {
namespace {

constexpr std::size_t kMostAnswer_bytes = 64u << 10;

struct Cleans {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreesHeaders {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

std::size_t take_answer(char* bytes, std::size_t one, std::size_t count, void* into) {
  auto& answer = *static_cast<std::string*>(into);
  answer.append(bytes, std::min(one * count, kMostAnswer_bytes - answer.size()));
  return one * count;
}

int asks_whether_it_ends(void* ends, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return (*static_cast<const std::function<bool()>*>(ends))() ? 1 : 0;
}

/// The statuses after which OTLP asks to send the same again.
bool is_away(long status) {
  return status == 429 || status == 502 || status == 503 || status == 504;
}

class Collector {
 public:
  explicit Collector(const Settings& settings) : settings_(settings), curl_(curl_easy_init()) {
    curl_slist* lines = curl_slist_append(nullptr, "Content-Type: application/json");
    for (const auto& [name, value] : settings.headers)
      lines = curl_slist_append(lines, (name + ": " + value).c_str());
    lines_.reset(lines);
    set_up(curl_.get());
  }
  Delivered post(const std::string& body, std::chrono::milliseconds most,
                 const std::function<bool()>& ends) {
    CURL* curl = curl_.get();
    if (!curl) return {Delivery::away, "libcurl does not start"};
    std::string answer;
    curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(most.count()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE_LARGE, static_cast<curl_off_t>(body.size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body.c_str());
    curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answer);
    curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &ends);
    const CURLcode code = curl_easy_perform(curl);
    if (code != CURLE_OK) return {Delivery::away, curl_easy_strerror(code)};
    long status = 0;
    curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
    if (status / 100 == 2) return {Delivery::taken, {}, rejected_spans(answer)};
    return {is_away(status) ? Delivery::away : Delivery::refused, fmt::format("status {}", status)};
  }

 private:
  void set_up(CURL* curl) {
    if (!curl) return;
    curl_easy_setopt(curl, CURLOPT_URL, settings_.url.c_str());
    curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
    curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, lines_.get());
    curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_answer);
    curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, asks_whether_it_ends);
    curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
    if (!settings_.authority.empty())
      curl_easy_setopt(curl, CURLOPT_CAINFO, settings_.authority.c_str());
  }

  const Settings settings_;
  std::unique_ptr<CURL, Cleans> curl_;
  std::unique_ptr<curl_slist, FreesHeaders> lines_;
};

}  // namespace

Post http_post(const Settings& settings) {
  curl_global_init(CURL_GLOBAL_DEFAULT);  // counted, and safe beside others since libcurl 7.84
  const auto collector = std::make_shared<Collector>(settings);
  return
      [collector](const std::string& body, std::chrono::milliseconds most,
                  const std::function<bool()>& ends) { return collector->post(body, most, ends); };
}

}  // namespace tracing
}  // namespace tractus
