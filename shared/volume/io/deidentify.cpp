#include "volume/io/deidentify.hpp"

#include <fmt/format.h>
#include <gdcmDicts.h>
#include <gdcmGlobal.h>
#include <sodium.h>

#include <algorithm>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_profile.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kImplementation = "2.25.215483729648203171629455386409371520001";
constexpr std::uint32_t kFrameCount = 0x00280008;
constexpr std::size_t kMostDecimals = 512;  // bytes: six decimal strings have at most 101
constexpr std::string_view kMethod = "Tractus: PS3.15 E.1-1 Basic, all but the geometry removed";

bool is_private(std::uint32_t tag) { return (tag >> 16) % 2 == 1; }

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank(" \0", 2);
  while (!text.empty() && kBlank.find(text.back()) != std::string_view::npos) text.remove_suffix(1);
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  return text;
}

std::vector<std::string_view> values_of(std::string_view text) {
  std::vector<std::string_view> out;
  for (std::size_t at = 0; at <= text.size();) {
    const auto end = std::min(text.find('\\', at), text.size());
    out.push_back(trimmed(text.substr(at, end - at)));
    at = end + 1;
  }
  return out;
}

bool is_term(std::string_view word, std::string_view terms) {
  if (word.empty() || word.find(' ') != std::string_view::npos) return false;
  const std::string within = " " + std::string(terms) + " ";
  return within.find(" " + std::string(word) + " ") != std::string::npos;
}

/// The words that are terms; others as OTHER, where that is one; empty: nothing is left.
std::string known_terms(std::string_view value, std::string_view terms) {
  const bool many = is_term("OTHER", terms);
  std::string out;
  const auto words = values_of(value);
  for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), many ? 8 : 1); ++i) {
    if (!many && !is_term(words[i], terms)) return {};
    out += (i ? "\\" : "");
    out += is_term(words[i], terms) ? words[i] : "OTHER";
  }
  return out;
}

void put(core::Bytes& out, std::uint32_t value, int bytes, bool big) {
  for (int b = 0; b < bytes; ++b)
    out.push_back(static_cast<std::byte>(value >> (8 * (big ? bytes - 1 - b : b)) & 0xff));
}

/// An element with a short text value, padded to an even length.
core::Bytes element(std::uint32_t tag, std::string_view vr, std::string value, bool with_vr,
                    bool big) {
  if (value.size() % 2) value += vr == "UI" ? '\0' : ' ';
  core::Bytes out;
  put(out, tag >> 16, 2, big);
  put(out, tag & 0xffff, 2, big);
  if (with_vr)
    for (const char c : vr) out.push_back(static_cast<std::byte>(c));
  put(out, static_cast<std::uint32_t>(value.size()), with_vr ? 2 : 4, big);
  std::ranges::copy(core::bytes_of(value), std::back_inserter(out));
  return out;
}

/// Pixel data of one frame: as it lies in the file, or as one fragment behind an empty table.
core::Bytes pixel_element(core::ByteView pixels, const DicomLayout& layout) {
  const bool big = layout.big_endian;
  const auto even = static_cast<std::uint32_t>(pixels.size() + pixels.size() % 2);
  core::Bytes out;
  const auto item = [&](std::uint32_t element, std::uint32_t length) {
    put(out, 0xfffe, 2, big);
    put(out, element, 2, big);
    put(out, length, 4, big);
  };
  put(out, 0x7fe0, 2, big);
  put(out, 0x0010, 2, big);
  if (layout.with_vr) {
    for (const char c : {'O', layout.compressed ? 'B' : 'W', '\0', '\0'})
      out.push_back(static_cast<std::byte>(c));
  }
  put(out, layout.compressed ? 0xffffffffu : even, 4, big);
  if (layout.compressed) item(0xe000, 0), item(0xe000, even);
  out.insert(out.end(), pixels.begin(), pixels.end());
  out.resize(out.size() + pixels.size() % 2);
  if (layout.compressed) item(0xe0dd, 0);
  return out;
}

bool is_decimals(std::string_view value) {
  return value.find_first_not_of(std::string_view("0123456789+-.eE\\ \0", 18)) ==
         std::string_view::npos;
}

std::string name_of(std::uint32_t tag) {
  const auto& dictionary = gdcm::Global::GetInstance().GetDicts().GetPublicDict();
  const char* name = dictionary
                         .GetDictEntry(gdcm::Tag(static_cast<std::uint16_t>(tag >> 16),
                                                 static_cast<std::uint16_t>(tag & 0xffff)))
                         .GetName();
  return name ? name : "";
}

core::Error no_numbers(std::uint32_t tag, const fs::path& path) {
  return bad(path, fmt::format("({:04x},{:04x}) {}: numbers are expected", tag >> 16, tag & 0xffff,
                               name_of(tag)));
}

}  // namespace

std::string replaced_uid(std::string_view uid, const UidKey& key) {
  std::array<unsigned char, 16> hash{};
  crypto_generichash(hash.data(), hash.size(), reinterpret_cast<const unsigned char*>(uid.data()),
                     uid.size(), reinterpret_cast<const unsigned char*>(key.data()), key.size());
  std::string digits;  // of the 128-bit number, by long division
  while (std::ranges::any_of(hash, [](unsigned char b) { return b != 0; })) {
    unsigned rest = 0;
    for (unsigned char& b : hash) {
      const unsigned part = rest << 8 | b;
      b = static_cast<unsigned char>(part / 10);
      rest = part % 10;
    }
    digits += static_cast<char>('0' + rest);
  }
  std::ranges::reverse(digits);
  return "2.25." + (digits.empty() ? "0" : digits);
}

/// A file under way: its kept elements by tag.
struct Deidentifier::Writing {
  core::ByteView file;
  const fs::path& path;
  const DicomLayout& layout;
  std::map<std::uint32_t, core::Bytes> kept{};
  std::string storage_class = "1.2.840.10008.5.1.4.1.1.2", instance = "2.25.0";
  bool by_frame = false;                 ///< pixels and places are each frame's
  std::optional<DicomElement> pixels{};  ///< of all frames
  std::string frames{};                  ///< their number, as the file states it

  std::string_view value(const DicomElement& e) const {
    return core::text_of(file.subspan(e.value_at, e.end - e.value_at));
  }
  void as_it_is(const DicomElement& e) {
    const auto bytes = file.subspan(e.at, e.end - e.at);
    kept.try_emplace(e.tag, bytes.begin(), bytes.end());
  }
  void replaced(const DicomElement& e, const char* vr, const std::string& value) {
    kept.try_emplace(e.tag, element(e.tag, vr, value, layout.with_vr, layout.big_endian));
  }
  core::Bytes whole() const {
    core::Bytes meta;
    const auto add = [&](const core::Bytes& bytes) {
      meta.insert(meta.end(), bytes.begin(), bytes.end());
    };
    // PS3.10 table 7.1-1: the version, what it is, how it is written, by whom.
    for (const unsigned b : {2u, 0u, 1u, 0u, 'O' + 0u, 'B' + 0u, 0u, 0u, 2u, 0u, 0u, 0u, 0u, 1u})
      meta.push_back(static_cast<std::byte>(b));
    add(element(0x00020002, "UI", storage_class, true, false));
    add(element(0x00020003, "UI", instance, true, false));
    add(element(0x00020010, "UI", layout.transfer_syntax, true, false));
    add(element(0x00020012, "UI", std::string(kImplementation), true, false));
    core::Bytes out(128, std::byte{0});
    std::ranges::copy(core::bytes_of("DICM"), std::back_inserter(out));
    for (const unsigned b : {2u, 0u, 0u, 0u, 'U' + 0u, 'L' + 0u, 4u, 0u})
      out.push_back(static_cast<std::byte>(b));
    put(out, static_cast<std::uint32_t>(meta.size()), 4, false);
    out.insert(out.end(), meta.begin(), meta.end());
    for (const auto& [tag, bytes] : kept) out.insert(out.end(), bytes.begin(), bytes.end());
    return out;
  }
};

void Deidentifier::note(const DicomElement& e, const char* done) {
  const std::uint32_t tag = is_private(e.tag) ? e.tag & 0xffff0000u : e.tag;
  Count& count = counts_[{tag, done}];
  ++(e.depth > 0 ? count.nested : count.whole);
  if (is_private(e.tag) || e.vr.size() != 2) return;
  const auto capital = [](char c) { return c >= 'A' && c <= 'Z'; };
  if (std::ranges::all_of(e.vr, capital)) vrs_.try_emplace(e.tag, e.vr);
}

void Deidentifier::suspect(const DicomElement& e, std::string_view value) {
  const auto words = values_of(value);
  const auto has = [&](std::string_view word) {
    return std::ranges::find(words, word) != words.end();
  };
  if (e.tag == 0x00280301 && has("YES"))
    suspicions_.insert("the file says that text is burnt into its pixels (BurnedInAnnotation)");
  if (e.tag == 0x00280302 && has("YES"))
    suspicions_.insert("the file says that a face can be recognised (RecognizableVisualFeatures)");
  if (e.tag == 0x00080008 && (has("SECONDARY") || has("SCREENSHOT") || has("SCREEN SAVE")))
    suspicions_.insert(
        "made from other pictures (ImageType): text may have been drawn into its pixels");
  const std::string_view uid = trimmed(value);
  if (e.tag == 0x00080064 || (e.tag == 0x00080016 && uid.starts_with("1.2.840.10008.5.1.4.1.1.7")))
    suspicions_.insert("a secondary capture: text may have been drawn into its pixels");
  if (e.tag == 0x00080060 && (has("SC") || has("OT") || has("DOC")))
    suspicions_.insert("no scan by its modality: text may have been drawn into its pixels");
  if (e.tag == 0x00180015)
    for (const char* part : {"HEAD", "FACE", "SKULL", "BRAIN", "HEADNECK", "NECK", "CSPINE"})
      if (has(part))
        suspicions_.insert("the head may be in the picture: faces are not removed here");
  if (e.tag >> 24 == 0x60 && (e.tag & 0xffff) == 0x0100 &&
      value.find_first_not_of('\0') != std::string_view::npos)
    suspicions_.insert("a graphic lies in unused bits of its pixels (overlay)");
}

core::Result<void> Deidentifier::take(const DicomElement& e, Writing& out) {
  if (e.depth < 0) return note(e, "replaced"), core::Result<void>();
  const auto row = e.depth == 0 ? kept_row(e.tag) : std::nullopt;
  if (e.depth == 0 && e.tag != 0x7fe00010) suspect(e, out.value(e));
  if (!row || out.kept.contains(e.tag)) return note(e, "removed"), core::Result<void>();
  const std::string_view value = out.value(e);
  switch (row->form) {
    case Form::new_uid: {
      const std::string uid = replaced_uid(trimmed(value), key_);
      if (e.tag == 0x00080018) out.instance = uid;
      out.replaced(e, "UI", uid);
      return note(e, "new identifier"), core::Result<void>();
    }
    case Form::terms: {
      const std::string known = known_terms(value, row->terms);
      if (known.empty()) return note(e, "removed"), core::Result<void>();
      if (e.tag == 0x00080016) out.storage_class = known;
      out.replaced(e, e.tag == 0x00080016 ? "UI" : "CS", known);
      break;
    }
    case Form::decimals:
      if (!is_decimals(value)) return no_numbers(e.tag, out.path);
      if (e.tag == kFrameCount) out.frames = trimmed(value);
      if (!out.by_frame || e.tag != kFrameCount) out.as_it_is(e);
      break;
    case Form::two_bytes:
      if (value.size() != 2) return note(e, "removed"), core::Result<void>();
      out.as_it_is(e);
      break;
    case Form::pixels:
      if (out.by_frame)
        out.pixels = e;
      else
        out.as_it_is(e);
  }
  return note(e, "kept"), core::Result<void>();
}

core::Result<void> Deidentifier::cleaned_frames(const FunctionalGroups& groups, Writing& out,
                                                const Keep& keep) {
  const auto frames = groups.frames();
  if (out.frames != std::to_string(frames.size()))
    return bad(out.path, fmt::format("places for {} frames, which is not their number: {}",
                                     frames.size(), kExportClassic));
  if (!out.pixels) return bad(out.path, "no pixel data");
  const auto pixels = TRY(frame_pixels(out.file, *out.pixels, out.layout, frames.size(), out.path));
  const std::string instance = out.instance;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const auto say = [&](std::uint32_t tag, const char* vr, std::string_view value) {
      out.kept[tag] =
          element(tag, vr, std::string(value), out.layout.with_vr, out.layout.big_endian);
    };
    for (const auto& [tag, e] : frames[n]) {
      const std::string_view value = out.value(e);
      if (!is_decimals(value) || value.size() > kMostDecimals) return no_numbers(tag, out.path);
      say(tag, "DS", trimmed(value));
    }
    out.instance = replaced_uid(instance + "." + std::to_string(n + 1), key_);
    say(0x00080018, "UI", out.instance);
    out.kept[0x7fe00010] = pixel_element(pixels[n], out.layout);
    TRY(keep(n + 1, out.whole()));
    for (const auto& [tag, e] : frames[n]) out.kept.erase(tag);
  }
  return {};
}

core::Result<void> Deidentifier::cleaned(core::ByteView file, const fs::path& path,
                                         const Keep& keep) {
  std::vector<DicomElement> elements;
  FunctionalGroups groups;
  const auto layout = TRY(parse_dicom_layout(file, path, [&](const DicomElement& e) {
    elements.push_back(e);
    groups.see(e);
  }));
  Writing out{file, path, layout};
  out.by_frame = groups.state_slices();
  for (const DicomElement& e : elements) {
    if (out.by_frame && groups.is_value(e))
      note(e, "kept");
    else
      TRY(take(e, out));
  }
  const auto say = [&](std::uint32_t tag, const char* vr, std::string_view value) {
    out.kept[tag] = element(tag, vr, std::string(value), layout.with_vr, layout.big_endian);
  };
  say(0x00120062, "CS", "YES");
  say(0x00120063, "LO", kMethod);
  ++files_;
  return out.by_frame ? cleaned_frames(groups, out, keep) : keep(0, out.whole());
}

core::Json Deidentifier::report() const {
  core::Json attributes = core::Json::array();
  for (const auto& [key, count] : counts_) {
    const auto& [tag, done] = key;
    const bool own = is_private(tag);
    const auto vr = vrs_.find(tag);
    attributes.push_back({{"tag", own ? fmt::format("({:04x},xxxx)", tag >> 16)
                                      : fmt::format("({:04x},{:04x})", tag >> 16, tag & 0xffff)},
                          {"name", own ? "private" : name_of(tag)},
                          {"vr", own || vr == vrs_.end() ? "" : vr->second},
                          {"profile", profile_action(tag)},
                          {"done", done},
                          {"count", count.whole},
                          {"nested", count.nested}});
  }
  return {{"format", "tractus-deidentification/1"},
          {"profile", kProfile},
          {"codes", {"113100", "113105"}},
          {"files", files_},
          {"attributes", attributes},
          {"text_in_pixels", "looked for, not removed: a person looks at the pictures"},
          {"faces", "not removed"}};
}

}  // namespace volume_io
}  // namespace tractus
