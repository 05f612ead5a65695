/// An OpenGL context of ours that VTK draws in.
#pragma once

class vtkGenericOpenGLRenderWindow;

namespace tractus::view {

/// Used by one thread at a time: the one in which it is current.
class LentContext {
 public:
  virtual ~LentContext() = default;
  /// False when it is lost.
  virtual bool make_current() const = 0;
};

/// Answers what VTK asks of a context that is not its own. `context` outlives `window`.
void lend_context(vtkGenericOpenGLRenderWindow& window, const LentContext& context);

}  // namespace tractus::view
