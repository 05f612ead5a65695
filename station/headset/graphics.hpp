/// OpenGL as it is handed to the runtime.
#pragma once

#include <memory>

#include "station/headset/instance.hpp"
#include "station/view/lent_context.hpp"

namespace tractus::headset {

/// A context of ours and the words in which a session is told of it. Current in the thread that
/// made it.
class Graphics {
 public:
  /// By the instance's binding; asks the runtime which versions of OpenGL it takes. Errors:
  /// unavailable (no context; a version outside).
  static core::Result<std::unique_ptr<Graphics>> make(const Instance& instance);
  virtual ~Graphics() = default;
  virtual const view::LentContext& context() const = 0;
  /// For XrSessionCreateInfo::next.
  virtual const void* binding() const = 0;
};

/// One file each: their headers' macros do not mix.
core::Result<std::unique_ptr<Graphics>> make_egl_graphics();
core::Result<std::unique_ptr<Graphics>> make_glx_graphics();

}  // namespace tractus::headset
