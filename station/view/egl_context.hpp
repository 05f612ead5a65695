/// An OpenGL context without a display, through EGL's surfaceless platform.
#pragma once

#include <memory>

#include "core/result.hpp"
#include "station/view/lent_context.hpp"

namespace tractus::view {

/// Makes and holds the context; current in the thread that made it.
/// Debian's GLEW knows only GLX and calls a missing X display an error although all entry points
/// were loaded; this file therefore interposes `glewInit` and forgives that one code while a
/// surfaceless context lives.
class EglContext final : public LentContext {
 public:
  /// Errors: unavailable, with what is missing.
  static core::Result<std::unique_ptr<EglContext>> make();
  ~EglContext() override;
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;
  bool make_current() const override;
  /// EGLDisplay, EGLConfig (may be null), EGLContext.
  void* display() const;
  void* config() const;
  void* context() const;

 private:
  struct Handles;
  explicit EglContext(std::unique_ptr<Handles> handles);
  std::unique_ptr<Handles> handles_;
};

}  // namespace tractus::view
