#include "volume/io/dicom_layout.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "core/try.hpp"
#include "volume/io/claims.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::uint32_t kUndefined = 0xffffffffu;
constexpr int kMaxDepth = 16;

constexpr std::uint32_t tag(std::uint32_t group, std::uint32_t element) {
  return group << 16 | element;
}
constexpr std::uint32_t kItem = tag(0xfffe, 0xe000), kItemEnd = tag(0xfffe, 0xe00d),
                        kSequenceEnd = tag(0xfffe, 0xe0dd);
constexpr std::uint32_t kPixels = tag(0x7fe0, 0x0010);

struct Syntax {
  std::string_view uid;
  bool compressed;
};
/// What vtk-dicom reads through GDCM, held against written series in the tests.
constexpr std::array kSyntaxes = {
    Syntax{"1.2.840.10008.1.2", false},      // implicit little-endian
    Syntax{"1.2.840.10008.1.2.1", false},    // explicit little-endian
    Syntax{"1.2.840.10008.1.2.2", false},    // explicit big-endian
    Syntax{"1.2.840.10008.1.2.5", true},     // RLE
    Syntax{"1.2.840.10008.1.2.4.50", true},  // JPEG baseline (8 bit)
    Syntax{"1.2.840.10008.1.2.4.51", true},  // JPEG extended (12 bit)
    Syntax{"1.2.840.10008.1.2.4.57", true},  // JPEG lossless
    Syntax{"1.2.840.10008.1.2.4.70", true},  // JPEG lossless, first-order prediction
    Syntax{"1.2.840.10008.1.2.4.80", true},  // JPEG-LS lossless
    Syntax{"1.2.840.10008.1.2.4.81", true},  // JPEG-LS near-lossless
    Syntax{"1.2.840.10008.1.2.4.90", true},  // JPEG 2000 lossless
    Syntax{"1.2.840.10008.1.2.4.91", true},  // JPEG 2000
};

/// The element at a place of the file.
struct Element {
  std::uint32_t tag = 0;
  std::string_view vr;  ///< empty in implicit syntaxes and of items
  std::uint32_t length = 0;
  std::size_t at = 0;  ///< of the element
  std::size_t value_at = 0;
};

class Walk {
 public:
  Walk(core::ByteView file, const fs::path& path, const ElementSeen& seen)
      : file_(file), path_(path), seen_(seen) {}

  core::Result<DicomMeta> meta() {
    std::size_t at = 132;
    while (at + 4 <= file_.size() && u16(at, false) == 0x0002) {
      auto element = TRY(next(at, file_.size(), true, false));
      const std::string_view value = core::text_of(file_.subspan(element.value_at, element.length));
      if (element.tag == tag(2, 0x10))
        layout_.transfer_syntax =
            std::string(value.substr(0, value.find_first_of(std::string_view(" \0", 2))));
      at = element.value_at + element.length;
      tell(element, at, -1);
    }
    return DicomMeta{layout_.transfer_syntax, at};
  }

  core::Result<DicomLayout> run() {
    const auto read = TRY(meta());
    TRY(choose_syntax());
    TRY(elements(read.end, file_.size(), explicit_, 0, false));
    return layout_;
  }

 private:
  std::uint32_t u16(std::size_t at, bool big) const {
    const auto a = std::to_integer<std::uint32_t>(file_[at]),
               b = std::to_integer<std::uint32_t>(file_[at + 1]);
    return big ? a << 8 | b : b << 8 | a;
  }
  std::uint32_t u32(std::size_t at, bool big) const {
    return big ? u16(at, true) << 16 | u16(at + 2, true)
               : u16(at + 2, false) << 16 | u16(at, false);
  }

  core::Result<void> choose_syntax() {
    for (const auto& syntax : kSyntaxes)
      if (syntax.uid == layout_.transfer_syntax) {
        explicit_ = syntax.uid != "1.2.840.10008.1.2";
        big_ = syntax.uid == "1.2.840.10008.1.2.2";
        layout_.compressed = syntax.compressed;
        layout_.with_vr = explicit_;
        layout_.big_endian = big_;
        return {};
      }
    return bad(path_, fmt::format("transfer syntax \"{}\" is not read",
                                  printable(layout_.transfer_syntax)));
  }

  void tell(const Element& e, std::size_t end, int depth) const {
    if (seen_) seen_({e.tag, e.vr, e.at, e.value_at, end, depth, item_at_});
  }

  core::Error lie(const Element& e, std::size_t left) const {
    return bad(path_,
               fmt::format("element ({:04x},{:04x}) at byte {} declares {} bytes, {} are left",
                           e.tag >> 16, e.tag & 0xffff, e.at, e.length, left));
  }

  /// The header of the element at `at`; a defined length is held against `end`.
  core::Result<Element> next(std::size_t at, std::size_t end, bool with_vr, bool big) const {
    const auto cut = [&] {
      return bad(path_, fmt::format("ends within an element at byte {}", at));
    };
    if (at + 8 > end) return cut();
    Element e;
    e.at = at;
    e.tag = tag(u16(at, big), u16(at + 2, big));
    e.value_at = at + 8;
    if (!with_vr || e.tag >> 16 == 0xfffe) {
      e.length = u32(at + 4, big);
    } else {
      e.vr = core::text_of(file_.subspan(at + 4, 2));
      constexpr std::string_view kLong = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
      if (kLong.find(e.vr) != std::string_view::npos && e.vr[0] > ' ') {
        if (at + 12 > end) return cut();
        e.length = u32(at + 8, big);
        e.value_at = at + 12;
      } else {
        e.length = u16(at + 6, big);
      }
    }
    if (e.length != kUndefined && e.length > end - e.value_at) return lie(e, end - e.value_at);
    return e;
  }

  /// Walks elements from `at` to `end`, or to the end of an item of undefined length; returns where
  /// it stopped.
  core::Result<std::size_t> elements(std::size_t at, std::size_t end, bool with_vr, int depth,
                                     bool open) {
    if (depth > kMaxDepth)
      return bad(path_, fmt::format("sequences nested over {} deep at byte {}", kMaxDepth, at));
    while (at < end) {
      auto e = TRY(next(at, end, with_vr, big_));
      if (e.tag == kItemEnd && open) return e.value_at;
      if (e.tag == kPixels && depth == 0) {
        TRY(pixels(e));
      }
      auto stop = TRY(value(e, end, with_vr, depth));
      tell(e, stop, depth);
      at = stop;
    }
    if (open) return bad(path_, fmt::format("a sequence's item has no end before byte {}", end));
    return at;
  }

  core::Result<std::size_t> value(const Element& e, std::size_t end, bool with_vr, int depth) {
    if (e.length == kUndefined)
      return items(e.value_at, end, with_vr && e.vr != "UN", depth + 1, true, e.tag == kPixels);
    const std::size_t stop = e.value_at + e.length;
    const bool looks_nested =
        e.vr == "SQ" || (e.vr.empty() && e.length >= 8 &&
                         tag(u16(e.value_at, big_), u16(e.value_at + 2, big_)) == kItem);
    if (looks_nested && e.length > 0) {
      TRY(items(e.value_at, stop, with_vr, depth + 1, false, false));
    }
    return stop;
  }

  /// Walks items from `at` to `end`, or to a sequence's end when its length is undefined; returns
  /// where it stopped.
  core::Result<std::size_t> items(std::size_t at, std::size_t end, bool with_vr, int depth,
                                  bool open, bool fragments) {
    while (at < end) {
      auto item = TRY(next(at, end, with_vr, big_));
      if (item.tag == kSequenceEnd && open) return item.value_at;
      if (item.tag != kItem)
        return bad(
            path_,
            fmt::format("element ({:04x},{:04x}) at byte {}, an item of a sequence is expected",
                        item.tag >> 16, item.tag & 0xffff, at));
      if (fragments) {
        if (item.length == kUndefined) return lie(item, end - item.value_at);
        first_fragment(item);
        at = item.value_at + item.length;
        continue;
      }
      const bool open_item = item.length == kUndefined;
      const std::size_t outer = std::exchange(item_at_, item.at);
      auto inner = TRY(elements(item.value_at, open_item ? end : item.value_at + item.length,
                                with_vr, depth, open_item));
      item_at_ = outer;
      at = inner;
    }
    if (open) return bad(path_, fmt::format("a sequence has no end before byte {}", end));
    return at;
  }

  core::Result<void> pixels(const Element& e) {
    if (layout_.compressed != (e.length == kUndefined))
      return bad(path_,
                 fmt::format("pixel data at byte {} {} in fragments, its transfer syntax {}", e.at,
                             layout_.compressed ? "is not" : "is", layout_.transfer_syntax));
    if (!layout_.compressed) {
      layout_.pixels_at = e.value_at;
      layout_.pixel_bytes = e.length;
    }
    return {};
  }

  /// The first item is the table of offsets, the second holds pixels.
  void first_fragment(const Element& item) {
    if (++fragments_ != 2) return;
    layout_.pixels_at = item.value_at;
    layout_.pixel_bytes = item.length;
  }

  core::ByteView file_;
  const fs::path& path_;
  const ElementSeen& seen_;
  DicomLayout layout_;
  bool explicit_ = true, big_ = false;
  int fragments_ = 0;
  std::size_t item_at_ = 0;
};

std::uint32_t be(core::ByteView bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t b = 0; b < size; ++b)
    value = value << 8 | std::to_integer<std::uint32_t>(bytes[at + b]);
  return value;
}

}  // namespace

bool looks_like_dicom(core::ByteView file) {
  return file.size() >= 132 && core::text_of(file.subspan(128, 4)) == "DICM";
}

core::Result<DicomMeta> parse_dicom_meta(core::ByteView file, const fs::path& path) {
  const ElementSeen nobody;
  return Walk(file, path, nobody).meta();
}

core::Result<DicomLayout> parse_dicom_layout(core::ByteView file, const fs::path& path,
                                             const ElementSeen& seen) {
  return Walk(file, path, seen).run();
}

std::pair<std::uint32_t, std::uint32_t> codestream_extent(core::ByteView s) {
  if (s.size() >= 24 && be(s, 0, 4) == 0xff4fff51)  // JPEG 2000: SOC, SIZ [ISO 15444-1, A.5.1]
    return {be(s, 12, 4) - be(s, 20, 4), be(s, 8, 4) - be(s, 16, 4)};
  if (s.size() < 4 || be(s, 0, 2) != 0xffd8) return {0, 0};
  for (std::size_t at = 2;
       at + 9 <= s.size();) {  // JPEG segments up to the frame header [ISO 10918-1, B.2.2]
    const std::uint32_t marker = be(s, at, 2);
    const bool frame = (marker >= 0xffc0 && marker <= 0xffcf && marker != 0xffc4 &&
                        marker != 0xffc8 && marker != 0xffcc) ||
                       marker == 0xfff7;  // JPEG-LS [ISO 14495-1, C.1.1]
    if (marker < 0xff01) return {0, 0};
    if (frame) return {be(s, at + 5, 2), be(s, at + 7, 2)};
    at += 2 + be(s, at + 2, 2);
  }
  return {0, 0};
}

}  // namespace volume_io
}  // namespace tractus
