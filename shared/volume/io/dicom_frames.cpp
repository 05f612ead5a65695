#include "volume/io/dicom_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "volume/io/claims.hpp"

namespace tractus {
namespace volume_io {
namespace {

constexpr std::uint32_t kSharedGroups = 0x52009229, kPerFrameGroups = 0x52009230;

/// A value and the macro's sequence in which it is stated.
struct FrameValue {
  std::uint32_t tag, sequence;
};
constexpr std::array kFrameValues{
    FrameValue{0x00200032, 0x00209113},  // plane position
    FrameValue{0x00200037, 0x00209116},  // plane orientation
    FrameValue{0x00280030, 0x00289110},  // pixel measures
    FrameValue{0x00281052, 0x00289145},  // pixel value transformation
    FrameValue{0x00281053, 0x00289145},
};

bool belongs(std::uint32_t tag, std::uint32_t sequence) {
  return std::ranges::any_of(kFrameValues, [&](const FrameValue& value) {
    return value.tag == tag && value.sequence == sequence;
  });
}

std::uint32_t little_u32(core::ByteView bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t b = 4; b-- > 0;) out = out << 8 | std::to_integer<std::uint32_t>(bytes[at + b]);
  return out;
}

/// The items of compressed pixels (PS3.5 A.4) behind the table of offsets.
std::vector<core::ByteView> fragments_of(core::ByteView file, const DicomElement& pixels) {
  constexpr std::uint32_t kItemTag = 0xe000fffe;  // as the bytes lie
  std::vector<core::ByteView> out;
  for (std::size_t at = pixels.value_at;
       at + 8 <= pixels.end && little_u32(file, at) == kItemTag;) {
    const std::size_t size = little_u32(file, at + 4);
    out.push_back(file.subspan(at + 8, size));  // the walk held the size against the file's
    at += 8 + size;
  }
  if (!out.empty()) out.erase(out.begin());
  return out;
}

}  // namespace

void FunctionalGroups::see(const DicomElement& e) {
  if (e.depth == 2) pending_.push_back(e);
  if (e.depth == 1) {
    Values& group = by_item_[e.item_at];
    for (const DicomElement& value : pending_)
      if (belongs(value.tag, e.tag)) group.try_emplace(value.tag, value);
    pending_.clear();
  }
  if (e.depth != 0) return;
  if (e.tag == 0x00200032) file_states_place_ = true;
  if (e.tag == kSharedGroups && !by_item_.empty()) shared_ = by_item_.begin()->second;
  if (e.tag == kPerFrameGroups) frames_ = std::move(by_item_);
  by_item_.clear();
  pending_.clear();
}

std::vector<FunctionalGroups::Values> FunctionalGroups::frames() const {
  std::vector<Values> out;
  for (const auto& [item_at, values] : frames_) {
    out.push_back(values);
    out.back().insert(shared_.begin(), shared_.end());  // the frame's own value stays
  }
  return out;
}

bool FunctionalGroups::is_value(const DicomElement& element) const {
  const auto holds = [&](const Values& values) {
    const auto found = values.find(element.tag);
    return found != values.end() && found->second.at == element.at;
  };
  const auto after = frames_.upper_bound(element.at);
  return holds(shared_) || (after != frames_.begin() && holds(std::prev(after)->second));
}

core::Result<std::vector<core::ByteView>> frame_pixels(core::ByteView file,
                                                       const DicomElement& pixels,
                                                       const DicomLayout& layout,
                                                       std::size_t frames,
                                                       const std::filesystem::path& path) {
  if (layout.compressed) {
    auto fragments = fragments_of(file, pixels);
    if (fragments.size() == frames) return fragments;
    return bad(path, fmt::format("{} frames in {} compressed pieces: {}", frames, fragments.size(),
                                 kExportClassic));
  }
  const core::ByteView all = file.subspan(pixels.value_at, pixels.end - pixels.value_at);
  const std::size_t size = all.size() / frames;
  if (size == 0 || all.size() - size * frames > 1)  // one byte more makes the length even
    return bad(path,
               fmt::format("pixel data of {} bytes is not that of {} frames", all.size(), frames));
  std::vector<core::ByteView> out;
  for (std::size_t n = 0; n < frames; ++n) out.push_back(all.subspan(n * size, size));
  return out;
}

}  // namespace volume_io
}  // namespace tractus
