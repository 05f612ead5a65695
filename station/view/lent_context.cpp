#include "station/view/lent_context.hpp"

#include <vtkCallbackCommand.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

namespace tractus::view {

void lend_context(vtkGenericOpenGLRenderWindow& window, const LentContext& context) {
  vtkNew<vtkCallbackCommand> current;
  current->SetClientData(const_cast<LentContext*>(&context));
  current->SetCallback([](vtkObject*, unsigned long event, void* data, void* answer) {
    const bool ok = static_cast<const LentContext*>(data)->make_current();
    if (event == vtkCommand::WindowIsCurrentEvent && answer) *static_cast<bool*>(answer) = ok;
  });
  window.AddObserver(vtkCommand::WindowMakeCurrentEvent, current);
  window.AddObserver(vtkCommand::WindowIsCurrentEvent, current);
}

}  // namespace tractus::view
