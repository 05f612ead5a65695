/// Controllers, where a person has any: shown where they are, a press recentres. Never needed.
#pragma once

#include <array>
#include <optional>

#include "station/headset/instance.hpp"
#include "station/headset/session.hpp"

namespace tractus::headset {

class Controls {
 public:
  /// What the hands do just now.
  struct State {
    std::array<std::optional<math::Pose>, 2> X_SG;  ///< grips in the room: left, right
    bool recentre = false;                          ///< was pressed since the last call
  };

  /// Runtimes without such input make controls that say nothing.
  Controls(const Instance& instance, const Session& session);
  ~Controls();
  Controls(const Controls&) = delete;
  Controls& operator=(const Controls&) = delete;

  State look(const Session& session, const Frame& frame);

 private:
  bool make_actions(const Instance& instance);
  bool attach(const Instance& instance, XrSession session);

  XrActionSet set_ = XR_NULL_HANDLE;
  XrAction grip_ = XR_NULL_HANDLE, recentre_ = XR_NULL_HANDLE;
  std::array<XrPath, 2> hands_{};
  std::array<XrSpace, 2> grips_{};
  bool attached_ = false;
};

}  // namespace tractus::headset
