#include "server/app/anchoring.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <syslog.h>
#include <unistd.h>

#include <chrono>

#include "core/file.hpp"
#include "core/try.hpp"
#include "server/api/web_fetch.hpp"
#include "server/app/log.hpp"

namespace tractus {
namespace app {
namespace {

using core::Result;

constexpr std::chrono::seconds kBetween{10};
constexpr std::size_t kMostWaiting = 1000;

/// The folder is not made: where another disk is to be mounted, there must be one.
Result<void> add_to_file(const std::string& path, const std::string& line) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (fd < 0) return core::system_error(path, "cannot open");
  const std::string text = line + "\n";
  const bool written = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fsync(fd) == 0;
  ::close(fd);
  if (written) return {};
  return core::system_error(path, "cannot write");
}

Result<void> post(const std::string& url, const std::string& line) {
  auto answer =
      TRY(api::fetch({.url = url, .form = std::map<std::string, std::string>{{"anchor", line}}}));
  if (answer.status >= 200 && answer.status < 300) return {};
  return core::Error{
      core::Errc::unavailable,
      fmt::format("{}: the server answered with the HTTP status {}", url, answer.status)};
}

Result<void> send_to(const AnchorPlace& place, const std::string& line) {
  switch (place.kind) {
    case AnchorPlace::Kind::file:
      return add_to_file(place.where, line);
    case AnchorPlace::Kind::http:
      return post(place.where, line);
    case AnchorPlace::Kind::syslog:
      break;
  }
  ::syslog(LOG_AUTHPRIV | LOG_NOTICE, "anchor %s", line.c_str());
  return {};
}

std::string name_of(const AnchorPlace& place) {
  return place.kind == AnchorPlace::Kind::syslog ? "syslog" : place.where;
}

}  // namespace

Result<AnchorPlace> anchor_place(const std::string& text) {
  if (text == "syslog") return AnchorPlace{AnchorPlace::Kind::syslog, ""};
  if (api::is_safe_address(text)) return AnchorPlace{AnchorPlace::Kind::http, text};
  std::error_code failure;
  const std::filesystem::path path(text);
  if (path.is_absolute() && std::filesystem::is_directory(path.parent_path(), failure))
    return AnchorPlace{AnchorPlace::Kind::file, text};
  return core::Error{core::Errc::bad_input,
                     fmt::format("--anchors-to {}: expected is syslog, an https address, or the "
                                 "absolute path of a file in an existing folder",
                                 text)};
}

AnchorSender::AnchorSender(AnchorPlace place)
    : place_(std::move(place)), thread_([this] { run(); }) {}

AnchorSender::~AnchorSender() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void AnchorSender::send(const std::string& line) {
  {
    const std::lock_guard held(mutex_);
    waiting_.push_back(line);
    if (waiting_.size() > kMostWaiting) waiting_.pop_front();
  }
  changed_.notify_all();
}

void AnchorSender::run() {
  std::unique_lock held(mutex_);
  while (true) {
    changed_.wait(held, [this] { return ending_ || !waiting_.empty(); });
    const bool sent = send_waiting(held);
    if (ending_) return;
    if (!sent) changed_.wait_for(held, kBetween, [this] { return ending_; });
  }
}

/// Oldest first; false when one could not be sent. Lets go of the lock while it sends.
bool AnchorSender::send_waiting(std::unique_lock<std::mutex>& held) {
  while (!waiting_.empty()) {
    const std::string line = waiting_.front();
    held.unlock();
    const auto sent = send_to(place_, line);
    tell(sent);
    held.lock();
    if (!sent) return false;
    if (!waiting_.empty() && waiting_.front() == line) waiting_.pop_front();
  }
  return true;
}

void AnchorSender::tell(const Result<void>& sent) {
  if (bool(sent) != failing_) return;
  failing_ = !sent;
  core::Json line{{"what", "anchors sent elsewhere"}, {"place", name_of(place_)}};
  if (!sent) line["error"] = sent.error().what;
  log_line(line);
}

Anchoring::Anchoring(DataFolder& data, const std::vector<AnchorPlace>& places) : data_(data) {
  for (const AnchorPlace& place : places) senders_.push_back(std::make_unique<AnchorSender>(place));
  if (const auto newest = newest_anchor(data)) {  // the one before may not have arrived
    for (auto& sender : senders_) sender->send(newest->line());
  }
  thread_ = std::thread([this] { run(); });
}

Anchoring::~Anchoring() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void Anchoring::note() {
  const auto noted = note_anchor(data_);
  if (!noted) return log_line({{"what", "audit anchor"}, {"error", noted.error().what}});
  if (!*noted) return;
  for (auto& sender : senders_) sender->send((*noted)->line());
}

void Anchoring::run() {
  std::unique_lock held(mutex_);
  while (true) {
    const bool last = changed_.wait_for(held, kBetween, [this] { return ending_; });
    note();
    if (last) return;
  }
}

}  // namespace app
}  // namespace tractus
