#include "station/app/kiosk_browser.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <vector>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace app {
namespace {
constexpr auto kLookAfter = std::chrono::milliseconds(200);
constexpr int kPauseSteps = 10;  // of kLookAfter, before a browser that ended is started again
}  // namespace

core::Result<std::unique_ptr<KioskBrowser>> KioskBrowser::start(const std::string& program,
                                                                const std::filesystem::path& folder,
                                                                const std::string& address) {
  std::error_code failure;
  const std::filesystem::path whole = std::filesystem::absolute(folder, failure);
  std::filesystem::create_directories(whole, failure);
  const std::string page = fmt::format(
      "<!doctype html><meta http-equiv=\"refresh\" content=\"0;url={}\"><title>Tractus</title>\n",
      address);
  TRY(core::write_file(whole / "start.html", core::bytes_of(page)));
  std::unique_ptr<KioskBrowser> made(new KioskBrowser(program, whole));
  const int child = TRY(made->spawn());
  made->thread_ = std::thread([raw = made.get(), child] { raw->watch(child); });
  return made;
}

core::Result<int> KioskBrowser::spawn() const {
  const std::string profile = "--user-data-dir=" + (folder_ / "browser").string();
  const std::string page = "file://" + (folder_ / "start.html").string();
  const std::vector<const char*> arguments{program_.c_str(),
                                           "--kiosk",
                                           "--incognito",
                                           "--no-first-run",
                                           "--disable-pinch",
                                           "--overscroll-history-navigation=0",
                                           "--disable-background-networking",
                                           "--disable-component-update",
                                           profile.c_str(),
                                           page.c_str(),
                                           nullptr};
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, program_.c_str(), nullptr, nullptr,
                                    const_cast<char* const*>(arguments.data()), environ);
  if (failed != 0)
    return core::Error{core::Errc::not_found,
                       fmt::format("--browser {}: {}; install Chromium, or open the address "
                                   "yourself with --no-browser",
                                   program_, std::strerror(failed))};
  return child;
}

void KioskBrowser::watch(int child) {
  while (!stop_) {
    int status = 0;
    if (::waitpid(child, &status, WNOHANG) == 0) {
      std::this_thread::sleep_for(kLookAfter);
      continue;
    }
    for (int i = 0; i < kPauseSteps && !stop_; ++i) std::this_thread::sleep_for(kLookAfter);
    if (stop_) return;
    const auto again = spawn();
    if (!again) return;
    child = *again;
  }
  ::kill(child, SIGTERM);
  ::waitpid(child, nullptr, 0);
}

KioskBrowser::~KioskBrowser() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace app
}  // namespace tractus
