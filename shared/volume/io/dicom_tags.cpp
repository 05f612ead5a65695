#include "volume/io/dicom_tags.hpp"

#include <fmt/format.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <set>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/dicom_frames.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
using volume::Vec3;
namespace {

const gdcm::Tag kModality(0x0008, 0x0060), kSeries(0x0020, 0x000e), kPosition(0x0020, 0x0032),
    kOrientation(0x0020, 0x0037), kSamples(0x0028, 0x0002), kPhotometric(0x0028, 0x0004),
    kFrames(0x0028, 0x0008), kRowCount(0x0028, 0x0010), kColumns(0x0028, 0x0011),
    kPixelSpacing(0x0028, 0x0030), kBits(0x0028, 0x0100), kSigned(0x0028, 0x0103),
    kIntercept(0x0028, 0x1052), kSlope(0x0028, 0x1053);

/// Attributes of one file; notes the first that is missing or is not what it should be.
class Attributes {
 public:
  Attributes(const gdcm::DataSet& set, const fs::path& path) : set_(set), path_(path) {}

  std::string text(const gdcm::Tag& tag) const {
    if (!set_.FindDataElement(tag)) return {};
    const gdcm::ByteValue* value = set_.GetDataElement(tag).GetByteValue();
    if (!value) return {};
    std::string out(value->GetPointer(), value->GetLength());
    while (!out.empty() && (out.back() == ' ' || out.back() == '\0')) out.pop_back();
    out.erase(0, out.find_first_not_of(' '));
    return out;
  }
  /// Decimal strings between backslashes, all finite.
  std::vector<double> decimals(const gdcm::Tag& tag, const char* name, std::size_t count) {
    std::string all = text(tag);
    std::vector<double> out;
    while (!all.empty()) {
      const std::string one = all.substr(0, all.find('\\'));
      all.erase(0, std::min(all.size(), one.size() + 1));
      const std::size_t from = std::min(one.find_first_not_of(" +"), one.size());
      double value = NAN;
      std::from_chars(one.data() + from, one.data() + one.size(), value);
      out.push_back(value);
    }
    const bool finite = std::ranges::all_of(out, [](double v) { return std::isfinite(v); });
    if (out.size() != count || !finite)
      wrong(fmt::format("{} \"{}\": {} numbers are expected", name, printable(text(tag)), count));
    out.resize(count);
    return out;
  }
  int whole(const gdcm::Tag& tag, const char* name) {
    const gdcm::ByteValue* value =
        set_.FindDataElement(tag) ? set_.GetDataElement(tag).GetByteValue() : nullptr;
    if (!value || value->GetLength() != 2) return wrong(fmt::format("{} is missing", name)), 0;
    std::uint16_t out = 0;
    std::memcpy(&out, value->GetPointer(), 2);
    return out;
  }
  bool has(const gdcm::Tag& tag) const { return !text(tag).empty(); }
  void wrong(const std::string& why) {
    if (!first_) first_ = bad(path_, why);
  }
  const std::optional<core::Error>& first() const { return first_; }

 private:
  const gdcm::DataSet& set_;
  const fs::path& path_;
  std::optional<core::Error> first_;
};

void read_geometry(Attributes& tags, Slice& slice) {
  if (!tags.has(kPosition) || !tags.has(kOrientation) || !tags.has(kPixelSpacing))
    return tags.wrong(
        "no image position, orientation or pixel spacing: it is no slice of a volume");
  const auto position = tags.decimals(kPosition, "image position", 3);
  const auto orientation = tags.decimals(kOrientation, "image orientation", 6);
  const auto spacing = tags.decimals(kPixelSpacing, "pixel spacing", 2);
  slice.position_m = Vec3(position[0], position[1], position[2]) * 1e-3;
  slice.along_row = Vec3(orientation[0], orientation[1], orientation[2]);
  slice.along_column = Vec3(orientation[3], orientation[4], orientation[5]);
  slice.column_step_m =
      spacing[0] * 1e-3;  // first between rows, then between columns, says PS3.3 10.7.1.3
  slice.row_step_m = spacing[1] * 1e-3;
}

void read_pixels(Attributes& tags, Slice& slice, const DicomLayout& layout, core::ByteView file) {
  slice.rows = tags.whole(kRowCount, "Rows");
  slice.columns = tags.whole(kColumns, "Columns");
  slice.bits = tags.whole(kBits, "Bits Allocated");
  slice.is_signed = tags.whole(kSigned, "Pixel Representation") == 1;
  if (tags.whole(kSamples, "Samples per Pixel") != 1 || tags.text(kPhotometric) != "MONOCHROME2")
    tags.wrong(
        fmt::format("photometric interpretation \"{}\": MONOCHROME2 of one sample is expected",
                    printable(tags.text(kPhotometric))));
  if (slice.bits != 8 && slice.bits != 16)
    tags.wrong(fmt::format("{} bits allocated: 8 or 16 are expected", slice.bits));
  if (slice.rows < 1 || slice.rows > 4096 || slice.columns < 1 || slice.columns > 4096)
    tags.wrong(
        fmt::format("{} rows and {} columns: 1 to 4096 are taken", slice.rows, slice.columns));
  const auto expected = static_cast<std::size_t>(slice.rows) *
                        static_cast<std::size_t>(slice.columns) *
                        static_cast<std::size_t>(slice.bits / 8);
  if (layout.pixels_at == 0) tags.wrong("no pixel data");
  if (!layout.compressed && layout.pixel_bytes != expected + expected % 2)
    tags.wrong(fmt::format("pixel data of {} bytes, {} rows of {} columns need {}",
                           layout.pixel_bytes, slice.rows, slice.columns, expected));
  if (layout.compressed && layout.pixels_at != 0) {
    const auto [rows, columns] =
        codestream_extent(file.subspan(layout.pixels_at, layout.pixel_bytes));
    const bool states_it = layout.transfer_syntax != "1.2.840.10008.1.2.5";  // RLE does not
    if (states_it && (rows != static_cast<std::uint32_t>(slice.rows) ||
                      columns != static_cast<std::uint32_t>(slice.columns)))
      tags.wrong(fmt::format("its compressed image is {} × {}, rows and columns say {} × {}", rows,
                             columns, slice.rows, slice.columns));
  }
}

core::Result<void> read_with_gdcm(gdcm::Reader& reader, const fs::path& path) {
  gdcm::Trace::WarningOff();
  gdcm::Trace::ErrorOff();
  gdcm::Trace::DebugOff();
  const std::set<gdcm::Tag> wanted = {
      kModality, kSeries,  kPosition,     kOrientation, kSamples, kPhotometric, kFrames,
      kRowCount, kColumns, kPixelSpacing, kBits,        kSigned,  kIntercept,   kSlope};
  reader.SetFileName(path.c_str());
  bool read = false;
  try {
    read = reader.ReadSelectedTags(wanted);
  } catch (const std::exception&) {
    read = false;
  }
  if (!read) return bad(path, "is damaged: its attributes cannot be read");
  return {};
}

}  // namespace

bool is_dicom_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 132> start{};
  file.read(start.data(), start.size());
  return file.gcount() == 132 && looks_like_dicom(std::as_bytes(std::span(start)));
}

core::Result<Slice> read_slice_tags(const fs::path& path) {
  const auto file = TRY(core::read_file(path, kSliceLimitBytes));
  const auto layout = TRY(parse_dicom_layout(file, path));
  gdcm::Reader reader;
  TRY(read_with_gdcm(reader, path));
  Attributes tags(reader.GetFile().GetDataSet(), path);
  Slice out;
  out.path = path;
  out.transfer_syntax = layout.transfer_syntax;
  out.series = tags.text(kSeries);
  out.modality = tags.text(kModality);
  if (out.series.empty()) tags.wrong("no series instance UID");
  if (const auto frames = tags.text(kFrames); !frames.empty() && frames != "1")
    tags.wrong(fmt::format("{} frames in one file, which states no place for each: {}",
                           printable(frames), kExportClassic));
  read_geometry(tags, out);
  read_pixels(tags, out, layout, file);
  if (tags.has(kSlope)) out.slope = tags.decimals(kSlope, "rescale slope", 1)[0];
  if (tags.has(kIntercept)) out.intercept = tags.decimals(kIntercept, "rescale intercept", 1)[0];
  if (!(out.slope > 0.0))
    tags.wrong(fmt::format("rescale slope {}: a number greater than 0 is expected", out.slope));
  if (tags.first()) return *tags.first();
  return out;
}

}  // namespace volume_io
}  // namespace tractus
