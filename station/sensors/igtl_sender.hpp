/// A tool's pose and forces to programs that listen by OpenIGTLink, as 3D Slicer and Plus do. Never
/// in the haptic loop: a thread of its own reads the latest state and sends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::sensors {

/// A tool at one moment, in the volume's frame V (LPS), m, N, N·m.
struct ToolMoment {
  math::Pose X_VT;  ///< of the tip
  math::Vec3 force_N = math::Vec3::Zero();
  math::Vec3 torque_Nm = math::Vec3::Zero();
};

/// The unit of a SENSOR message (igtl_unit.h of the protocol): newton, newton metre.
enum class IgtlUnit : std::uint64_t {
  newton = 0x0Bull << 54 | 1ull << 50,
  newton_metre = 0x0Bull << 54 | 1ull << 50 | 0x01ull << 44 | 1ull << 40,
};

/// A TRANSFORM message, header version 1. The pose is given in LPS and m and sent in RAS and mm, in
/// which 3D Slicer takes it. `device`: at most 20 characters. `stamp_s`: since 1970, UTC.
std::vector<std::byte> igtl_transform(const std::string& device, const math::Pose& pose,
                                      double stamp_s);
/// A SENSOR message: values with one unit. Vectors are sent in RAS, as poses are.
std::vector<std::byte> igtl_sensor(const std::string& device, const math::Vec3& value_lps,
                                   IgtlUnit unit, double stamp_s);

/// Serves up to kMostListeners connections with the messages TractusTip (TRANSFORM), TractusForce
/// and TractusTorque (SENSOR) 60 times a second while there is a moment. What listeners send is read
/// and ignored. A listener that does not read misses whole messages; it slows nobody.
class IgtlSender {
 public:
  static constexpr int kMostListeners = 8;
  static constexpr int kRate_Hz = 60;
  using Latest = std::function<std::optional<ToolMoment>()>;

  /// Listens on an address such as "127.0.0.1" and a port (0: any free one). `latest` is called by
  /// the sender's thread. Errors: unavailable naming address and port.
  static core::Result<std::unique_ptr<IgtlSender>> start(const std::string& address, int port,
                                                         Latest latest);
  ~IgtlSender();
  IgtlSender(const IgtlSender&) = delete;
  IgtlSender& operator=(const IgtlSender&) = delete;
  int port() const noexcept { return port_; }

 private:
  struct Listener {
    int fd = -1;
    std::vector<std::byte> rest;  ///< of a message that was sent in part
  };
  IgtlSender(int fd, int port, Latest latest);
  void run(std::stop_token stop);
  void accept();
  void send(std::span<const std::byte> message);
  /// False: the listener is gone.
  static bool send(Listener& to, std::span<const std::byte> message);
  static bool is_open(const Listener& listener);

  int fd_;
  int port_;
  Latest latest_;
  std::vector<Listener> listeners_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace tractus::sensors
