#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageGaussianSmooth.h>
#include <vtkImageGradient.h>
#include <vtkMultiThreader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>

#include "bench/field_preparation/rivals.hpp"
#include "bench/support/report.hpp"

namespace tractus::bench {

Prepared vtk_rival(const Opacities& opacities) {
  vtkMultiThreader::SetGlobalMaximumNumberOfThreads(1);
  const auto& n = opacities.dims;
  vtkNew<vtkFloatArray> scalars;
  scalars->SetArray(const_cast<float*>(opacities.alpha.data()), vtkIdType(opacities.alpha.size()),
                    1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(n[0], n[1], n[2]);
  image->GetPointData()->SetScalars(scalars);

  const auto smooth = vtkSmartPointer<vtkImageGaussianSmooth>::New();
  smooth->SetInputData(image);
  smooth->SetDimensionality(3);
  smooth->SetStandardDeviations(1.0, 1.0, 1.0);
  smooth->SetRadiusFactors(7.0, 7.0, 7.0);
  vtkNew<vtkImageGradient> gradient;
  gradient->SetInputConnection(smooth->GetOutputPort());
  gradient->SetDimensionality(3);
  const double time_s = seconds(1, process_s, [&] { gradient->Update(); });
  return {time_s, [smooth](int i, int j, int k) {
            return smooth->GetOutput()->GetScalarComponentAsDouble(i, j, k, 0);
          }};
}

}  // namespace tractus::bench
