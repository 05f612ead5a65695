#include "volume/scalar_grid.hpp"

#include <sys/mman.h>

#include <utility>

namespace tractus {
namespace volume {
namespace {

constexpr std::size_t kLineFloats = 16;  // 64 bytes

std::size_t odd_lines(std::size_t floats) { return ((floats + kLineFloats - 1) / kLineFloats) | 1; }

std::size_t row_floats(const std::array<int, 3>& dims) {
  return odd_lines(std::size_t(dims[0])) * kLineFloats;
}

std::size_t slice_floats(const std::array<int, 3>& dims) {
  return odd_lines(row_floats(dims) * std::size_t(dims[1])) * kLineFloats;
}

}  // namespace

std::size_t ScalarGrid::bytes_for(const std::array<int, 3>& dims) noexcept {
  return (slice_floats(dims) * std::size_t(dims[2]) + kLineFloats) * sizeof(float);
}

std::optional<ScalarGrid> ScalarGrid::make(const std::array<int, 3>& dims, Use use) noexcept {
  ScalarGrid grid;
  grid.dims_ = dims;
  grid.row_pitch_ = std::ptrdiff_t(row_floats(dims));
  grid.slice_pitch_ = std::ptrdiff_t(slice_floats(dims));
  grid.bytes_ = bytes_for(dims);
  const int flags = MAP_PRIVATE | MAP_ANONYMOUS | (use == Use::whole ? 0 : MAP_NORESERVE);
  void* const memory = mmap(nullptr, grid.bytes_, PROT_READ | PROT_WRITE, flags, -1, 0);
  if (memory == MAP_FAILED) return std::nullopt;
  // Huge pages: fewer address misses; a kernel without them is slower, not wrong. For a part, they would take in
  // what lies between its rows.
  madvise(memory, grid.bytes_, use == Use::whole ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  grid.data_ = static_cast<float*>(memory);
  return grid;
}

ScalarGrid::ScalarGrid(ScalarGrid&& other) noexcept
    : dims_(other.dims_),
      row_pitch_(other.row_pitch_),
      slice_pitch_(other.slice_pitch_),
      bytes_(other.bytes_),
      data_(std::exchange(other.data_, nullptr)) {}

ScalarGrid::~ScalarGrid() {
  if (data_) munmap(data_, bytes_);
}

}  // namespace volume
}  // namespace tractus
