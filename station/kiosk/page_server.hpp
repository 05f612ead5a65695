/// Serves the kiosk's page to a browser of this machine, and holds its WebSocket.
#pragma once

#include <filesystem>
#include <memory>
#include <thread>

#include "server/http/server.hpp"
#include "station/kiosk/desk.hpp"

namespace tractus::kiosk {

/// On 127.0.0.1 alone. A request whose Host or Origin is another's is refused (a page of another
/// site, by its own name for this address), and so is a WebSocket without the secret, which is new
/// at every start: other users of this machine do not know it.
class PageServer {
 public:
  /// Serves until this goes. `desk` outlives it.
  /// @param web   folder of the built pages
  /// @param port  0: any free port
  /// Errors: not_found (no kiosk.html in `web`), unavailable (port).
  static core::Result<std::unique_ptr<PageServer>> open(Desk& desk,
                                                        const std::filesystem::path& web,
                                                        std::uint16_t port);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  std::uint16_t port() const noexcept;
  /// "http://127.0.0.1:PORT/kiosk.html#SECRET": whoever has it drives the kiosk. What follows '#'
  /// never leaves the browser as part of a request for a page.
  std::string address() const;

 private:
  struct Parts;
  explicit PageServer(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::kiosk
