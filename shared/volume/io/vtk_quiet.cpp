#include "volume/io/vtk_quiet.hpp"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkNew.h>
#include <vtkObject.h>

#include "volume/io/claims.hpp"

namespace tractus {
namespace volume_io {
namespace {

void keep_first(vtkObject*, unsigned long, void* kept, void* text) {
  auto& first = *static_cast<std::string*>(kept);
  if (first.empty() && text) first = printable(static_cast<const char*>(text));
}

}  // namespace

VtkErrors::VtkErrors(vtkObject* watched)
    : watched_(watched), displayed_(vtkObject::GetGlobalWarningDisplay()) {
  vtkNew<vtkCallbackCommand> command;
  command->SetCallback(keep_first);
  command->SetClientData(&first_);
  observer_ = watched_->AddObserver(vtkCommand::ErrorEvent, command);
  vtkObject::GlobalWarningDisplayOff();
}

VtkErrors::~VtkErrors() {
  watched_->RemoveObserver(observer_);
  vtkObject::SetGlobalWarningDisplay(displayed_);
}

}  // namespace volume_io
}  // namespace tractus
