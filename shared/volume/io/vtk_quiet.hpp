/// VTK says what is wrong on standard error, in many lines, and goes on; here it is caught as one.
#pragma once

#include <string>

class vtkObject;

namespace tractus::volume_io {

/// While this lives, the object's errors are kept (the first one), and nothing of VTK's is printed.
class VtkErrors {
 public:
  explicit VtkErrors(vtkObject* watched);
  ~VtkErrors();
  VtkErrors(const VtkErrors&) = delete;
  VtkErrors& operator=(const VtkErrors&) = delete;
  /// The first error's text on one line, empty when there was none.
  const std::string& first() const { return first_; }

 private:
  vtkObject* watched_;
  unsigned long observer_ = 0;
  int displayed_ = 0;
  std::string first_;
};

}  // namespace tractus::volume_io
