/// The browser that shows the kiosk: Chromium, full screen, started anew when it ends.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "core/result.hpp"

namespace tractus::app {

class KioskBrowser {
 public:
  /// The address is written to a file that its owner alone reads, `folder`/start.html, which the
  /// browser opens: an argument could be read by every user of this machine.
  /// Errors: not_found (no such program), io.
  static core::Result<std::unique_ptr<KioskBrowser>> start(const std::string& program,
                                                           const std::filesystem::path& folder,
                                                           const std::string& address);
  /// Ends the browser.
  ~KioskBrowser();
  KioskBrowser(const KioskBrowser&) = delete;
  KioskBrowser& operator=(const KioskBrowser&) = delete;

 private:
  KioskBrowser(std::string program, std::filesystem::path folder)
      : program_(std::move(program)), folder_(std::move(folder)) {}
  core::Result<int> spawn() const;
  void watch(int child);

  std::string program_;
  std::filesystem::path folder_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace tractus::app
