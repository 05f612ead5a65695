#include "volume/blur.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <span>
#include <vector>

#include "volume/blur_kernels.hpp"

namespace tractus {
namespace volume {
namespace {

using blur_kernels::Store;
constexpr int kTaps = blur_kernels::kTaps;
// A tile's window of 16 slices, 72 rows of 128 floats, is two thirds of a 1 MiB level-2 cache.
constexpr int kTileX = 128, kTileY = 72;
constexpr int kWindow = 16;  // slices held: so many are needed for four results
// Floats from row to row and from slice to slice: odd numbers of cache lines (scalar_grid.hpp says
// why).
constexpr int kPitch = kTileX + 16, kSlicePitch = kPitch * kTileY + 16;
// With fewer tiles than this side by side, they are cut along z too, this deep.
constexpr int kColumns = 16, kTileZ = 96;

int rounded_up(int n, int to) { return (n + to - 1) / to * to; }

/// What one thread works in.
struct Scratch {
  std::vector<float> row, rows, window;
  Scratch()
      : row(kTileX + 2 * 8),
        rows(std::size_t(kPitch) * (kTileY + 2 * kTaps)),
        window(std::size_t(kSlicePitch) * kWindow) {}
};

/// One tile: a box of results at most kTileX × kTileY wide, streamed through along z.
class Tile {
 public:
  Tile(const Volume& volume, const OpacityRamps& ramps, const Box& box, Scratch& scratch,
       const BlurTarget& target)
      : volume_(volume),
        ramps_(ramps),
        box_(box),
        scratch_(scratch),
        target_(target),
        width_(rounded_up(box.end[0] - box.begin[0], 8)),
        height_(box.end[1] - box.begin[1]) {}

  template <Store kStore>
  void blur() {
    const int last = volume_.geometry.dims[2] - 1;
    int next = std::max(box_.begin[2] - kTaps, 0);  // the next slice to enter the window
    for (int z = box_.begin[2]; z < box_.end[2];) {
      const int count = box_.end[2] - z >= 4 ? 4 : 1;
      for (; next <= std::min(z + count - 1 + kTaps, last); ++next) enter(next);
      across_slices<kStore>(z, count);
      z += count;
    }
  }

 private:
  float* window_row(int z, int y) {
    return scratch_.window.data() + (z % kWindow) * kSlicePitch + y * kPitch;
  }

  /// Opacity of slice z blurred along x and y, into the window.
  void enter(int z) {
    const int last = volume_.geometry.dims[1] - 1, first_row = box_.begin[1] - kTaps;
    const int rows = height_ + 2 * kTaps;
    const float* sources[kTileY + 2 * kTaps];
    for (int r = 0; r < rows; ++r) {
      const int y = std::clamp(first_row + r, 0, last);
      float* const out = scratch_.rows.data() + std::size_t(r) * kPitch;
      const bool repeated = r > 0 && y == std::clamp(first_row + r - 1, 0, last);
      if (!repeated) along_row(y, z, out);
      sources[r] = repeated ? sources[r - 1] : out;
    }
    int y = 0;
    for (; y + 4 <= height_; y += 4) {
      float* const out[4] = {window_row(z, y), window_row(z, y + 1), window_row(z, y + 2),
                             window_row(z, y + 3)};
      blur_kernels::across_four<Store::cached>(weights_, sources + y, width_, out);
    }
    for (; y < height_; ++y)
      blur_kernels::across_one<Store::cached>(weights_, sources + y, width_, window_row(z, y));
  }

  /// Opacity of a row blurred along x. Eight floats lie before the first voxel of the tile.
  void along_row(int y, int z, float* out) {
    const int last = volume_.geometry.dims[0] - 1;
    const int from = box_.begin[0] - kTaps, to = box_.begin[0] + width_ + kTaps;  // voxels wanted
    const int have_from = std::max(from, 0), have_to = std::min(to, last + 1);
    float* const row = scratch_.row.data() + 8 - box_.begin[0];  // row[x] is voxel x
    prefetch(have_from, have_to, y, std::min(z + 1, volume_.geometry.dims[2] - 1));
    ramps_.opacities(volume_.counts.data() + volume_.offset(have_from, y, z), have_to - have_from,
                     row + have_from);
    std::fill(row + from, row + have_from, row[have_from]);
    std::fill(row + have_to, row + to, row[last]);
    blur_kernels::along_row(weights_, row + box_.begin[0], width_, out);
  }

  /// Fetches counts of the next slice: the strides of a tile are too wild for the processor to
  /// foresee.
  void prefetch(int from, int to, int y, int z) const {
    constexpr int kLineCounts = 32;
    const std::uint16_t* const counts = volume_.counts.data() + volume_.offset(0, y, z);
    for (int x = from; x < to; x += kLineCounts)
      _mm_prefetch(reinterpret_cast<const char*>(counts + x), _MM_HINT_T0);
  }

  /// Slice z of the result or, when `count` is 4, z … z + 3, from the window.
  template <Store kStore>
  void across_slices(int z, int count) {
    const int last = volume_.geometry.dims[2] - 1;
    for (int y = 0; y < height_; ++y) {
      const float* sources[kWindow];
      for (int m = 0; m < kWindow; ++m)
        sources[m] = window_row(std::clamp(z - kTaps + m, 0, last), y);
      float* const first = target_.at(box_.begin[0], box_.begin[1] + y, z);
      const std::ptrdiff_t pitch = target_.slice_pitch;
      float* const out[4] = {first, first + pitch, first + 2 * pitch, first + 3 * pitch};
      if (count == 4)
        blur_kernels::across_four<kStore>(weights_, sources, width_, out);
      else
        blur_kernels::across_one<kStore>(weights_, sources, width_, first);
    }
  }

  const Volume& volume_;
  const OpacityRamps& ramps_;
  const Box box_;
  Scratch& scratch_;
  const BlurTarget target_;
  const int width_, height_;
  const blur_kernels::Weights weights_;
};

/// The box cut into tiles; rows begin at multiples of 8.
std::vector<Box> tiles_of(const Box& box) {
  const int columns = rounded_up(box.end[0] - box.begin[0], kTileX) / kTileX *
                      (rounded_up(box.end[1] - box.begin[1], kTileY) / kTileY);
  const int depth = columns >= kColumns ? box.end[2] - box.begin[2] : kTileZ;
  std::vector<Box> tiles;
  for (int z = box.begin[2]; z < box.end[2]; z += depth)
    for (int y = box.begin[1]; y < box.end[1]; y += kTileY)
      for (int x = box.begin[0] / 8 * 8; x < box.end[0]; x += kTileX)
        tiles.push_back({{x, y, z},
                         {std::min(x + kTileX, box.end[0]), std::min(y + kTileY, box.end[1]),
                          std::min(z + depth, box.end[2])}});
  return tiles;
}

/// Tells how many tiles are done, from whichever thread has done one; remembers a wish to stop.
class Count {
 public:
  Count(const core::Progress& progress, std::size_t of) : progress_(progress), of_(of) {}
  bool stopped() const { return stopped_; }
  void one_more() {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    if (!progress_(double(++done_) / double(of_))) stopped_ = true;
  }

 private:
  const core::Progress& progress_;
  const std::size_t of_;
  std::size_t done_ = 0;
  std::atomic<bool> stopped_{false};
  std::mutex mutex_;
};

bool blur_tiles(const Volume& volume, const OpacityRamps& ramps, const Box& box,
                const core::Progress& progress, const BlurTarget& target) {
  const std::vector<Box> tiles = tiles_of(box);
  Count count(progress, tiles.size());
  const auto work = [&](std::span<const Box> share) {
    static thread_local Scratch scratch;
    for (const Box& tile : share) {
      if (count.stopped()) return;
      if (tiles.size() > 8)
        Tile(volume, ramps, tile, scratch, target).blur<Store::streamed>();
      else
        Tile(volume, ramps, tile, scratch, target).blur<Store::cached>();
      count.one_more();
    }
  };
  if (tiles.size() == 1)
    work(tiles);
  else
    tbb::parallel_for(std::size_t(0), tiles.size(),
                      [&](std::size_t k) { work(std::span(tiles).subspan(k, 1)); });
  _mm_sfence();
  return !count.stopped();
}

}  // namespace

bool blur(const Volume& volume, const OpacityRamps& ramps, const Box& box,
          const core::Progress& progress, ScalarGrid& grid) {
  return blur_tiles(volume, ramps, box, progress,
                    {grid.row(0, 0), {0, 0, 0}, grid.row_pitch(), grid.slice_pitch()});
}

void blur(const Volume& volume, const OpacityRamps& ramps, const Box& box,
          const BlurTarget& target) {
  blur_tiles(volume, ramps, box, {}, target);
}

}  // namespace volume
}  // namespace tractus
