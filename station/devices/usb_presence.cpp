#include "station/devices/usb_presence.hpp"

#include <fmt/format.h>
#include <libusb.h>

namespace tractus {
namespace devices {
namespace {
/// A session with the system's USB.
struct Session {
  libusb_context* context = nullptr;
  int failed = libusb_init(&context);
  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  ~Session() {
    if (!failed) libusb_exit(context);
  }
};

core::Error no_usb(int code) {
  return {core::Errc::unavailable,
          fmt::format("the system gives no access to its USB: {}", libusb_error_name(code))};
}

/// Opens and claims, and lets go: what that comes to.
UsbPresence try_to_open(libusb_device* device) {
  libusb_device_handle* handle = nullptr;
  const int opened = libusb_open(device, &handle);
  if (opened == LIBUSB_ERROR_ACCESS) return UsbPresence::no_permission;
  if (opened == LIBUSB_ERROR_BUSY) return UsbPresence::in_use;
  if (opened != LIBUSB_SUCCESS) return UsbPresence::absent;  // went while we looked
  const int claimed = libusb_claim_interface(handle, 0);
  if (claimed == LIBUSB_SUCCESS) libusb_release_interface(handle, 0);
  libusb_close(handle);
  return claimed == LIBUSB_ERROR_BUSY ? UsbPresence::in_use : UsbPresence::present;
}
}  // namespace

core::Result<UsbFinding> look_for_usb(std::uint16_t vendor) {
  const Session session;
  if (session.failed) return no_usb(session.failed);
  libusb_device** list = nullptr;
  const auto count = libusb_get_device_list(session.context, &list);
  if (count < 0) return no_usb(int(count));
  UsbFinding out;
  for (ssize_t k = 0; k < count; ++k) {
    libusb_device_descriptor is{};
    if (libusb_get_device_descriptor(list[k], &is) != 0 || is.idVendor != vendor) continue;
    out = {try_to_open(list[k]), fmt::format("bus {}, device {}", libusb_get_bus_number(list[k]),
                                             libusb_get_device_address(list[k]))};
    if (out.presence == UsbPresence::present) break;
  }
  libusb_free_device_list(list, 1);
  return out;
}

std::string text_of(const UsbFinding& finding, const std::string& device) {
  switch (finding.presence) {
    case UsbPresence::absent:
      return fmt::format("{}: nothing of vendor {:04x} is on the USB: plug it in and switch it on",
                         device, kForceDimension);
    case UsbPresence::no_permission:
      return fmt::format(
          "{}: found ({}), but this user may not open it: install deploy/udev/70-tractus.rules",
          device, finding.where);
    case UsbPresence::in_use:
      return fmt::format("{}: found ({}), but another program has it: end that first", device,
                         finding.where);
    case UsbPresence::present:
      return "";
  }
  return "";
}

struct UsbWatch::Context {
  Session session;
};

UsbWatch::UsbWatch() : context_(std::make_unique<Context>()) {}

core::Result<std::unique_ptr<UsbWatch>> UsbWatch::start(std::uint16_t vendor) {
  std::unique_ptr<UsbWatch> out(new UsbWatch);
  const Session& session = out->context_->session;
  if (session.failed) return no_usb(session.failed);
  const auto changed = [](libusb_context*, libusb_device*, libusb_hotplug_event event,
                          void* self) -> int {
    static_cast<UsbWatch*>(self)->there_ += event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED ? 1 : -1;
    return 0;
  };
  const int registered = libusb_hotplug_register_callback(
      session.context, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
      LIBUSB_HOTPLUG_ENUMERATE, vendor, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, changed,
      out.get(), nullptr);
  if (registered != LIBUSB_SUCCESS) return no_usb(registered);
  out->thread_ = std::thread([watch = out.get()] { watch->watch(); });
  return out;
}

UsbWatch::~UsbWatch() {
  stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void UsbWatch::watch() {
  while (!stop_) {
    timeval wait{.tv_sec = 0, .tv_usec = 20'000};
    libusb_handle_events_timeout_completed(context_->session.context, &wait, nullptr);
  }
}

}  // namespace devices
}  // namespace tractus
