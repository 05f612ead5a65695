#include "volume/io/dicom_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_files.hpp"
#include "volume/io/dicom_frames.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
using volume::Vec3;
namespace {

constexpr std::size_t kMostListed = 20;

/// A file's texts by tag, of those that tell series apart.
using Texts = std::map<std::uint32_t, std::string>;
constexpr std::uint32_t kModalityTag = 0x00080060, kThickness = 0x00180050, kKernel = 0x00181210,
                        kSeriesUid = 0x0020000e, kSeriesNumber = 0x00200011, kPlace = 0x00200032,
                        kDirections = 0x00200037, kSpacing = 0x00280030;
constexpr std::array kTelling{kModalityTag,  kThickness, kKernel,     kSeriesUid,
                              kSeriesNumber, kPlace,     kDirections, kSpacing};

std::string text_in(const Texts& texts, std::uint32_t tag) {
  const auto found = texts.find(tag);
  return found == texts.end() ? "" : found->second;
}

struct Member {
  fs::path path;
  Texts texts;                        ///< of the first slice
  std::vector<double> places_mm;      ///< of each slice along its normal, where they are stated
  std::optional<core::Error> damage;  ///< by which no more of the file could be told
  std::string text(std::uint32_t tag) const { return text_in(texts, tag); }
};

std::string without_padding(std::string_view text) {
  constexpr std::string_view kPadding(" \0", 2);
  const auto from = text.find_first_not_of(kPadding);
  if (from == std::string_view::npos) return {};
  return std::string(text.substr(from, text.find_last_not_of(kPadding) + 1 - from));
}

/// Of the characters in `allowed` alone and not over `most`; else empty: it may be anybody's words.
std::string of_form(const std::string& text, std::string_view allowed, std::size_t most) {
  return text.size() <= most && text.find_first_not_of(allowed) == std::string::npos ? text : "";
}

constexpr std::string_view kDigits = "0123456789";

std::vector<double> decimals_of(const std::string& text, std::size_t count) {
  std::vector<double> out;
  for (std::size_t at = 0; at <= text.size() && out.size() <= count;) {
    const auto end = std::min(text.find('\\', at), text.size());
    const auto from = std::min(text.find_first_not_of(" +", at), end);
    double value = NAN;
    std::from_chars(text.data() + from, text.data() + end, value);
    out.push_back(value);
    at = end + 1;
  }
  const bool finite = std::ranges::all_of(out, [](double v) { return std::isfinite(v); });
  return out.size() == count && finite ? out : std::vector<double>{};
}

/// Of a slice along its normal; NAN where the file states no position.
double place_mm(const Texts& texts) {
  const auto p = decimals_of(text_in(texts, kPlace), 3);
  const auto d = decimals_of(text_in(texts, kDirections), 6);
  if (p.empty() || d.empty()) return NAN;
  return Vec3(d[0], d[1], d[2]).cross(Vec3(d[3], d[4], d[5])).dot(Vec3(p[0], p[1], p[2]));
}

/// The median distance between neighbours; NAN where there are no two.
double spacing_mm(std::vector<double> places) {
  std::erase_if(places, [](double place) { return !std::isfinite(place); });
  std::ranges::sort(places);
  std::vector<double> gaps;
  for (std::size_t i = 1; i < places.size(); ++i) gaps.push_back(places[i] - places[i - 1]);
  if (gaps.empty()) return NAN;
  std::ranges::sort(gaps);
  return gaps[gaps.size() / 2];
}

core::Result<Member> told(DicomFiles& files, const fs::path& path) {
  const auto file = TRY(files.read(path));
  Member out{path, {}, {}, {}};
  FunctionalGroups groups;
  const auto text = [&](const DicomElement& e) {
    const auto value = core::ByteView(file).subspan(e.value_at, e.end - e.value_at);
    return without_padding(core::text_of(value));
  };
  const auto layout = parse_dicom_layout(file, path, [&](const DicomElement& e) {
    groups.see(e);
    if (e.depth != 0 || std::ranges::find(kTelling, e.tag) == kTelling.end()) return;
    out.texts.try_emplace(e.tag, text(e));
  });
  if (!layout) out.damage = layout.error();
  if (!groups.state_slices()) {
    out.places_mm = {place_mm(out.texts)};
    return out;
  }
  for (const auto& frame : groups.frames()) {
    Texts texts;
    for (const auto& [tag, e] : frame) texts.try_emplace(tag, text(e));
    out.places_mm.push_back(place_mm(texts));
    out.texts.insert(texts.begin(), texts.end());
  }
  return out;
}

using Members = std::vector<const Member*>;

std::string described(const std::string& uid, const Members& members) {
  const Member& first = *members.front();
  std::vector<double> places;
  for (const Member* member : members)
    places.insert(places.end(), member->places_mm.begin(), member->places_mm.end());
  std::string out = of_form(uid, "0123456789.", 64);
  if (out.empty()) out = "a UID that is not valid";
  out += " (";
  if (const auto number = of_form(first.text(kSeriesNumber), kDigits, 12); !number.empty())
    out += fmt::format("number {}, ", number);
  if (const auto word = of_form(first.text(kModalityTag), "ABCDEFGHIJKLMNOPQRSTUVWXYZ", 16);
      !word.empty())
    out += word + ", ";
  out += fmt::format("{} {}", places.size(), places.size() == 1 ? "slice" : "slices");
  if (const auto pixel = decimals_of(first.text(kSpacing), 2); !pixel.empty())
    out += fmt::format(", pixels {:.4g} × {:.4g} mm", pixel[0], pixel[1]);
  if (const double step = spacing_mm(places); std::isfinite(step))
    out += fmt::format(", spacing {:.4g} mm", step);
  if (const auto thick = decimals_of(first.text(kThickness), 1); !thick.empty())
    out += fmt::format(", thickness {:.4g} mm", thick[0]);
  // A kernel's name, as B60f or BONE: PS3.15 table E.1-1 does not list it, so it names nobody.
  constexpr std::string_view kNames =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789 _.+-/\\";
  if (const auto kernel = of_form(first.text(kKernel), kNames, 32); !kernel.empty())
    out += fmt::format(", kernel {}", kernel);
  return out + ")";
}

using Groups = std::map<std::string, Members>;

std::string list_of(const Groups& groups) {
  std::vector<std::pair<std::string, Members>> most(groups.begin(), groups.end());
  std::ranges::stable_sort(most, std::ranges::greater{},
                           [](auto& one) { return one.second.size(); });
  std::string out;
  for (std::size_t i = 0; i < std::min(most.size(), kMostListed); ++i)
    out += (i ? "; " : "") + described(most[i].first, most[i].second);
  if (most.size() > kMostListed) out += fmt::format("; and {} more", most.size() - kMostListed);
  return out;
}

}  // namespace

core::Result<Listing> chosen_series(const Listing& listing, const std::string& series_uid,
                                    const fs::path& from) {
  std::vector<Member> members;
  DicomFiles files;
  for (const fs::path& path : listing.files) members.push_back(TRY(told(files, path)));
  Groups groups;
  for (const Member& member : members) {
    const std::string uid = member.text(kSeriesUid);
    // A damaged file matters if it may be of the series that is read.
    if (member.damage && (uid.empty() || series_uid.empty() || uid == series_uid))
      return *member.damage;
    if (uid.empty()) return bad(member.path, "no series instance UID");
    groups[uid].push_back(&member);
  }
  if (series_uid.empty() && groups.size() > 1)
    return bad(from, fmt::format("holds {} series; choose one by its Series Instance UID (tractus "
                                 "import --series UID, or series_uid of an upload): {}",
                                 groups.size(), list_of(groups)));
  const auto group = series_uid.empty() ? groups.begin() : groups.find(series_uid);
  if (group == groups.end())
    return bad(from, fmt::format("holds no series {}; it holds {}", printable(series_uid),
                                 list_of(groups)));
  Listing out{.files = {}, .others = listing.others};
  for (const Member* member : group->second) out.files.push_back(member->path);
  out.other_series = listing.files.size() - out.files.size();
  return out;
}

}  // namespace volume_io
}  // namespace tractus
