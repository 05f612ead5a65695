#include <itkDiscreteGaussianImageFilter.h>
#include <itkGradientImageFilter.h>
#include <itkImage.h>
#include <itkImportImageFilter.h>
#include <itkMultiThreaderBase.h>

#include "bench/field_preparation/rivals.hpp"
#include "bench/support/report.hpp"

namespace tractus::bench {

Prepared itk_rival(const Opacities& opacities) {
  using Image = itk::Image<float, 3>;
  itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(1);
  itk::MultiThreaderBase::SetGlobalDefaultNumberOfThreads(1);
  const auto& n = opacities.dims;
  auto import = itk::ImportImageFilter<float, 3>::New();
  import->SetRegion(Image::RegionType(Image::SizeType{
      { itk::SizeValueType(n[0]),
        itk::SizeValueType(n[1]),
        itk::SizeValueType(n[2]) }}));
  import->SetImportPointer(const_cast<float*>(opacities.alpha.data()), opacities.alpha.size(),
                           false);

  auto smooth = itk::DiscreteGaussianImageFilter<Image, Image>::New();
  smooth->SetInput(import->GetOutput());
  smooth->SetVariance(1.0);
  smooth->SetMaximumKernelWidth(15);
  auto gradient = itk::GradientImageFilter<Image, float, float>::New();
  gradient->SetInput(smooth->GetOutput());
  const double time_s = seconds(1, process_s, [&] { gradient->Update(); });
  return {time_s, [smooth](int i, int j, int k) {
            return double(smooth->GetOutput()->GetPixel({{i, j, k}}));
          }};
}

}  // namespace tractus::bench
