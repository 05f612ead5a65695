/// What a test tells the runtime, and what it saw.
#pragma once

#include <atomic>
#include <cstdint>

#include "tests/support/mapped_page.hpp"  // how both come by it

namespace tractus::fakexr {

struct Control {
  // What is offered.
  std::atomic<int> offer_opengl{1}, offer_egl{1}, offer_stage{1}, controllers{1};
  std::atomic<int> width_px{320}, height_px{320};
  std::atomic<double> outward_rad{0.75}, inward_rad{0.65}, up_rad{0.7}, down_rad{0.7};
  std::atomic<double> eyes_apart_m{0.064};
  std::atomic<double> head_m[3]{0.0, 1.6, 0.0};
  std::atomic<double> head_yaw_rad{0.0}, head_pitch_rad{0.0};  ///< to the left, up
  std::atomic<int> paced{1};  ///< 0: its clock jumps to the next frame, nobody waits
  std::atomic<double> rate_Hz{90.0};
  // Faults. Frames are counted from 1; 0: never.
  std::atomic<int> no_system{0}, refuse_graphics{0};
  std::atomic<std::uint64_t> lose_session_at{0}, lose_instance_at{0}, call_fails_at{0};
  std::atomic<std::uint64_t> untracked_from{0}, untracked_to{0};
  std::atomic<std::uint64_t> late_at{0}, late_by{0};      ///< so many periods
  std::atomic<std::uint64_t> take_off_at{0}, quit_at{0};  ///< the person does
  std::atomic<std::uint64_t> press_at{0};                 ///< select, for one frame
  std::atomic<std::uint64_t> keep_at{0};                  ///< its pictures, as PNG in `folder`
  char folder[256] = {};
  // Seen.
  std::atomic<std::uint64_t> frames{0}, shown{0},
      in_head{0};                          ///< with a layer; in the head's frame
  std::atomic<std::uint64_t> lit_px[2]{};  ///< of the last picture looked at: unlike its corner
  std::atomic<std::uint64_t> sessions_ended{0}, instances{0}, swapchains{0};
  std::atomic<int> binding{0};  ///< of the last session: 1 GLX, 2 EGL
  std::atomic<int> violations{0};
  char words[8192] = {};  ///< a line each
};

}  // namespace tractus::fakexr
