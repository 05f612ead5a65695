#include "station/devices/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus::devices {

std::vector<DeviceInfo> all(DeviceKind kind) {
  std::vector<DeviceInfo> out = all();
  std::erase_if(out, [&](const DeviceInfo& info) { return info.kind != kind; });
  return out;
}

std::optional<DeviceInfo> find(const std::string& id) {
  for (DeviceInfo& info : all())
    if (info.id == id) return std::move(info);
  return std::nullopt;
}

core::Result<DeviceInfo> find(const std::string& id, DeviceKind kind) {
  auto info = find(id);
  if (info && info->kind == kind) return std::move(*info);
  return core::Error{core::Errc::not_found,
                     fmt::format("--device {}: {} is expected", id, listed(kind))};
}

bool is_rig(const std::string& id) {
  const auto info = find(id);
  return info && info->kind == DeviceKind::rig;
}

bool is_simulated(const std::string& id) {
  const auto info = find(id);
  return info && info->simulated;
}

std::string listed(const std::vector<DeviceInfo>& devices) {
  std::string out;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (i > 0) out += i + 1 == devices.size() ? " or " : ", ";
    out += devices[i].id;
  }
  return out;
}

std::string listed(DeviceKind kind) { return listed(all(kind)); }

std::string listed(AddressedBy addressed_by) {
  std::vector<DeviceInfo> those = all();
  std::erase_if(those, [&](const DeviceInfo& info) { return info.addressed_by != addressed_by; });
  return listed(those);
}

}  // namespace tractus::devices
