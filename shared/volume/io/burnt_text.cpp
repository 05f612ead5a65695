#include "volume/io/burnt_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

namespace tractus {
namespace volume_io {
namespace {

constexpr int kSlices = 32;
constexpr int kLow = 5, kHigh = 48;  // pixels: a letter's height
constexpr std::size_t kLetters = 4;  // on one line, to be called text
constexpr double kContrast = 150.0;  // CT values between strokes and their ground

struct Area {
  const char* name;
  int left, top, right, bottom;  ///< half-open, pixels
};

/// A connected piece of strokes.
struct Piece {
  int left, top, right, bottom;  ///< closed, pixels
  int pixels;
  int height() const { return bottom - top + 1; }
  int width() const { return right - left + 1; }
};

bool like_a_letter(const Piece& p) {
  if (p.height() < kLow || p.height() > kHigh || p.width() > 2 * p.height()) return false;
  const double filled = double(p.pixels) / (double(p.height()) * p.width());
  const bool bar = p.width() * 4 <= p.height();  // I, l, 1
  return filled >= 0.12 && (filled <= 0.72 || bar);
}

/// The pieces of a mask, 8-connected. `mask` is used up.
std::vector<Piece> pieces_of(std::vector<char>& mask, int width, int height) {
  std::vector<Piece> out;
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = [&](int px, int py) -> char& {
        return mask[std::size_t(py) * std::size_t(width) + std::size_t(px)];
      };
      if (!at(x, y)) continue;
      Piece piece{x, y, x, y, 0};
      open.assign(1, {x, y});
      at(x, y) = 0;
      while (!open.empty()) {
        const auto [px, py] = open.back();
        open.pop_back();
        ++piece.pixels;
        piece.left = std::min(piece.left, px), piece.right = std::max(piece.right, px);
        piece.top = std::min(piece.top, py), piece.bottom = std::max(piece.bottom, py);
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int nx = px + dx, ny = py + dy;
            if (nx < 0 || ny < 0 || nx >= width || ny >= height || !at(nx, ny)) continue;
            at(nx, ny) = 0;
            open.emplace_back(nx, ny);
          }
      }
      out.push_back(piece);
    }
  return out;
}

/// Do enough letters of like height stand on one line, one close after the other?
bool has_line(std::vector<Piece> letters) {
  std::ranges::sort(letters, {}, &Piece::left);
  for (const Piece& first : letters) {
    const int slack = std::max(1, first.height() / 6);
    std::size_t run = 1;
    const Piece* last = &first;
    for (const Piece& next : letters) {
      if (next.left <= last->right || std::abs(next.bottom - first.bottom) > slack ||
          std::abs(next.height() - first.height()) > slack)
        continue;
      if (next.left - last->right > 2 * first.height()) break;
      ++run;
      last = &next;
    }
    if (run >= kLetters) return true;
  }
  return false;
}

/// Bright strokes on a dark ground (`sign` 1), or dark on bright (-1).
bool has_text(const volume::Volume& v, int k, const Area& area, int sign) {
  const int width = area.right - area.left, height = area.bottom - area.top;
  if (width < 4 * kLow || height < kLow) return false;
  std::vector<int> values;
  values.reserve(std::size_t(width) * std::size_t(height));
  for (int j = area.top; j < area.bottom; ++j)
    for (int i = area.left; i < area.right; ++i)
      values.push_back(sign * v.counts[v.offset(i, j, k)]);
  std::vector<int> sorted = values;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, middle);
  const int ground = *middle, peak = *std::ranges::max_element(values);
  if ((peak - ground) * v.slope < kContrast) return false;
  const int threshold = ground + (peak - ground) / 2;
  std::vector<char> mask(values.size());
  std::ranges::transform(values, mask.begin(), [&](int value) { return value > threshold; });
  std::vector<Piece> letters = pieces_of(mask, width, height);
  std::erase_if(letters, [](const Piece& p) { return !like_a_letter(p); });
  return has_line(std::move(letters));
}

}  // namespace

std::vector<std::string> text_suspicions(const volume::Volume& v) {
  const auto [width, height, slices] = v.geometry.dims;
  const int third = height / 3, half = width / 2;
  const Area areas[] = {{"top left", 0, 0, half, third},
                        {"top right", half, 0, width, third},
                        {"bottom left", 0, height - third, half, height},
                        {"bottom right", half, height - third, width, height},
                        {"top", half / 2, 0, width - half / 2, third},
                        {"bottom", half / 2, height - third, width - half / 2, height}};
  const int looked_at = std::min(slices, kSlices);
  std::map<std::string, int> found;
  for (int n = 0; n < looked_at; ++n) {
    const int k = static_cast<int>((std::int64_t{n} * slices) / looked_at);
    for (const Area& area : areas)
      if (has_text(v, k, area, 1) || has_text(v, k, area, -1)) ++found[area.name];
  }
  std::vector<std::string> out;
  for (const auto& [place, count] : found)
    out.push_back(
        fmt::format("something like a line of text at the {} of {} of {} slices looked at", place,
                    count, looked_at));
  return out;
}

}  // namespace volume_io
}  // namespace tractus
