/// The blurred opacity of a volume in memory, laid out for sampling.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace tractus::volume {

/// Floats [k][j][i]. Rows and slices are an odd number of cache lines apart: with a power of two
/// between them, the rows of one sample would fall into the same few cache sets and cost half as
/// much again. Unused floats are zero or an opacity, never NaN, so that a row may be read eight
/// floats at a time from any voxel and weighed by 0.
class ScalarGrid {
 public:
  /// Whether all rows will be written, or a few of them: untouched ones then take no memory.
  enum class Use { whole, a_part };
  /// Nothing when the memory is not to be had.
  static std::optional<ScalarGrid> make(const std::array<int, 3>& dims,
                                        Use use = Use::whole) noexcept;
  ~ScalarGrid();
  ScalarGrid(ScalarGrid&& other) noexcept;
  ScalarGrid& operator=(ScalarGrid&&) = delete;

  float* row(int j, int k) noexcept { return data_ + offset(j, k); }
  const float* row(int j, int k) const noexcept { return data_ + offset(j, k); }
  const float* at(int i, int j, int k) const noexcept { return row(j, k) + i; }
  const std::array<int, 3>& dims() const noexcept { return dims_; }
  std::ptrdiff_t row_pitch() const noexcept { return row_pitch_; }  ///< floats from row to row
  std::ptrdiff_t slice_pitch() const noexcept {
    return slice_pitch_;
  }  ///< floats from slice to slice
  static std::size_t bytes_for(const std::array<int, 3>& dims) noexcept;

 private:
  ScalarGrid() = default;
  std::ptrdiff_t offset(int j, int k) const noexcept { return k * slice_pitch_ + j * row_pitch_; }
  std::array<int, 3> dims_{};
  std::ptrdiff_t row_pitch_ = 0, slice_pitch_ = 0;
  std::size_t bytes_ = 0;
  float* data_ = nullptr;
};

}  // namespace tractus::volume
