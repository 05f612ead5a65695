/// An OpenGL context on an X display that no window of ours shows.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "station/view/lent_context.hpp"

namespace tractus::view {

/// Makes and holds the context, its pixel buffer and its connection to the display ($DISPLAY);
/// current in the thread that made it. For OpenXR runtimes, which take GLX on X11.
class GlxContext final : public LentContext {
 public:
  /// As Xlib and GLX name them, without their headers (whose macros are everywhere).
  struct Handles {
    void* display = nullptr;     ///< Display*
    unsigned visual = 0;         ///< VisualID
    void* config = nullptr;      ///< GLXFBConfig
    unsigned long drawable = 0;  ///< GLXDrawable
    void* context = nullptr;     ///< GLXContext
  };

  /// Errors: unavailable, with what is missing.
  static core::Result<std::unique_ptr<GlxContext>> make();
  ~GlxContext() override;
  GlxContext(const GlxContext&) = delete;
  GlxContext& operator=(const GlxContext&) = delete;
  bool make_current() const override;
  const Handles& handles() const { return handles_; }

 private:
  GlxContext() = default;
  core::Result<void> open();
  Handles handles_;
};

}  // namespace tractus::view
