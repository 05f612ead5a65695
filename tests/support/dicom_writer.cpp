#include "tests/support/dicom_writer.hpp"

#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmSequenceOfItems.h>
#include <gdcmTrace.h>
#include <gdcmWriter.h>

#include <cmath>
#include <cstring>

#include "core/require.hpp"

namespace tractus {
namespace test_support {
namespace fs = std::filesystem;
using volume::Vec3;
using volume::Volume;
namespace {

void text(gdcm::DataSet& set, std::uint16_t group, std::uint16_t element, gdcm::VR::VRType vr,
          std::string value) {
  if (value.size() % 2) value += vr == gdcm::VR::UI ? '\0' : ' ';
  gdcm::DataElement out(gdcm::Tag(group, element));
  out.SetVR(vr);
  out.SetByteValue(value.data(), static_cast<std::uint32_t>(value.size()));
  set.Replace(out);
}

void number(gdcm::DataSet& set, std::uint16_t group, std::uint16_t element, std::uint16_t value) {
  gdcm::DataElement out(gdcm::Tag(group, element));
  out.SetVR(gdcm::VR::US);
  out.SetByteValue(reinterpret_cast<const char*>(&value), 2);
  set.Replace(out);
}

std::string decimals(const Vec3& v, double unit) {
  return fmt::format("{:.10g}\\{:.10g}\\{:.10g}", v.x() * unit, v.y() * unit, v.z() * unit);
}

/// A sequence with these items in `set`, of undefined lengths.
void nest(gdcm::DataSet& set, std::uint16_t group, std::uint16_t element,
          const std::vector<gdcm::DataSet>& items) {
  gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = new gdcm::SequenceOfItems;
  sequence->SetLengthToUndefined();
  for (const gdcm::DataSet& inner : items) {
    gdcm::Item item;
    item.SetVLToUndefined();
    item.SetNestedDataSet(inner);
    sequence->AddItem(item);
  }
  gdcm::DataElement nested(gdcm::Tag(group, element));
  nested.SetVR(gdcm::VR::SQ);
  nested.SetValue(*sequence);
  nested.SetVLToUndefined();
  set.Replace(nested);
}

void plant_patient(gdcm::DataSet& set) {
  text(set, 0x0010, 0x0010, gdcm::VR::PN, "Mustermann^Erika");
  text(set, 0x0010, 0x0020, gdcm::VR::LO, "PID-4711-0815");
  text(set, 0x0010, 0x0030, gdcm::VR::DA, "19470823");
  text(set, 0x0008, 0x0080, gdcm::VR::LO, "Sanatorium Waldfrieden");
  text(set, 0x0008, 0x1070, gdcm::VR::PN, "Nurse^Ratched");
  text(set, 0x0008, 0x0050, gdcm::VR::SH, "ACC-99-1234");
  text(set, 0x0009, 0x0010, gdcm::VR::LO, "ACME");
  text(set, 0x0009, 0x1001, gdcm::VR::LO, "ACME private diary");
  gdcm::DataSet referenced;
  text(referenced, 0x0010, 0x0010, gdcm::VR::PN, "Mustermann^Erika^Referrer");
  nest(set, 0x0008, 0x1120, {referenced});  // referenced patient sequence
}

void describe(gdcm::DataSet& set, const Volume& v, int k, const DicomSeries& series) {
  const auto& g = v.geometry;
  const Vec3 shift = g.directions.col(1) * (k * g.spacing_m.z() * std::tan(series.tilt_rad));
  text(set, 0x0008, 0x0016, gdcm::VR::UI, "1.2.840.10008.5.1.4.1.1.2");  // CT image
  text(set, 0x0008, 0x0018, gdcm::VR::UI, fmt::format("{}.1.{}", series.series_uid, k + 1));
  text(set, 0x0008, 0x0060, gdcm::VR::CS, "CT");
  text(set, 0x0018, 0x0050, gdcm::VR::DS, fmt::format("{:.10g}", g.spacing_m.z() * 1e3));
  text(set, 0x0020, 0x000d, gdcm::VR::UI, "2.25.271828182845904");
  text(set, 0x0020, 0x000e, gdcm::VR::UI, series.series_uid);
  text(set, 0x0020, 0x0013, gdcm::VR::IS, std::to_string(k + 1));
  text(set, 0x0020, 0x0032, gdcm::VR::DS, decimals(g.position_of({0, 0, double(k)}) + shift, 1e3));
  text(set, 0x0020, 0x0037, gdcm::VR::DS,
       decimals(g.directions.col(0), 1) + "\\" + decimals(g.directions.col(1), 1));
  text(set, 0x0020, 0x0052, gdcm::VR::UI, "2.25.161803398874989");
  number(set, 0x0028, 0x0002, 1);
  text(set, 0x0028, 0x0004, gdcm::VR::CS, "MONOCHROME2");
  number(set, 0x0028, 0x0010, static_cast<std::uint16_t>(g.dims[1]));
  number(set, 0x0028, 0x0011, static_cast<std::uint16_t>(g.dims[0]));
  text(set, 0x0028, 0x0030, gdcm::VR::DS,
       fmt::format("{:.10g}\\{:.10g}", g.spacing_m.y() * 1e3, g.spacing_m.x() * 1e3));
  number(set, 0x0028, 0x0100, 16);
  number(set, 0x0028, 0x0101, 16);
  number(set, 0x0028, 0x0102, 15);
  number(set, 0x0028, 0x0103, series.signed_pixels ? 1 : 0);
  const double slope = (series.signed_pixels ? 1.0 : v.slope) + k * series.slope_drift;
  text(set, 0x0028, 0x1052, gdcm::VR::DS,
       fmt::format("{:.10g}", series.signed_pixels ? 0.0 : v.intercept));
  text(set, 0x0028, 0x1053, gdcm::VR::DS, fmt::format("{:.10g}", slope));
}

void put_pixels(gdcm::DataSet& set, const Volume& v, int k, bool signed_pixels) {
  std::vector<std::uint16_t> stored;
  for (int j = 0; j < v.geometry.dims[1]; ++j)
    for (int i = 0; i < v.geometry.dims[0]; ++i)
      stored.push_back(signed_pixels ? static_cast<std::uint16_t>(
                                           static_cast<std::int16_t>(std::lround(v.value(i, j, k))))
                                     : v.counts[v.offset(i, j, k)]);
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetVR(gdcm::VR::OW);
  pixels.SetByteValue(reinterpret_cast<const char*>(stored.data()),
                      static_cast<std::uint32_t>(stored.size() * 2));
  set.Replace(pixels);
}

/// Attributes of one file's `from` that move into a functional group (PS3.3 C.7.6.16.2).
gdcm::DataSet taken_out(gdcm::DataSet& from, std::vector<gdcm::Tag> tags) {
  gdcm::DataSet out;
  for (const gdcm::Tag& tag : tags) {
    if (!from.FindDataElement(tag)) continue;  // it was moved before
    out.Replace(from.GetDataElement(tag));
    from.Remove(tag);
  }
  return out;
}

/// The group of slice k, without what all slices share; `set` loses it.
gdcm::DataSet own_group(gdcm::DataSet& set, bool with_scaling) {
  gdcm::DataSet out, comments;
  text(comments, 0x0020, 0x9158, gdcm::VR::LT, "Mustermann^Erika");
  nest(out, 0x0020, 0x9111, {comments});  // frame content
  nest(out, 0x0020, 0x9113, {taken_out(set, {{0x0020, 0x0032}})});
  const auto scaling = taken_out(set, {{0x0028, 0x1052}, {0x0028, 0x1053}});
  if (with_scaling) nest(out, 0x0028, 0x9145, {scaling});
  return out;
}

gdcm::DataSet shared_group(gdcm::DataSet& set, bool with_scaling) {
  gdcm::DataSet out;
  nest(out, 0x0020, 0x9116, {taken_out(set, {{0x0020, 0x0037}})});
  nest(out, 0x0028, 0x9110, {taken_out(set, {{0x0028, 0x0030}, {0x0018, 0x0050}})});
  if (with_scaling)
    nest(out, 0x0028, 0x9145, {taken_out(set, {{0x0028, 0x1052}, {0x0028, 0x1053}})});
  return out;
}

/// Rewrites a file in another transfer syntax.
void change_syntax(const fs::path& path, const std::string& uid) {
  gdcm::ImageReader reader;
  reader.SetFileName(path.c_str());
  core::require(reader.Read(), "what was just written can be read");
  gdcm::ImageChangeTransferSyntax change;
  change.SetTransferSyntax(gdcm::TransferSyntax(gdcm::TransferSyntax::GetTSType(uid.c_str())));
  change.SetInput(reader.GetImage());
  core::require(change.Change(), "GDCM compresses in every syntax of the list");
  gdcm::ImageWriter writer;
  writer.SetFile(reader.GetFile());
  writer.SetImage(change.GetOutput());
  writer.SetFileName(path.c_str());
  core::require(writer.Write(), "a test's DICOM file can be written");
}

}  // namespace

std::vector<fs::path> write_dicom_series(const fs::path& folder, const Volume& v,
                                         const DicomSeries& series) {
  gdcm::Trace::WarningOff();
  fs::create_directories(folder);
  std::vector<fs::path> out;
  for (int k = 0; k < v.geometry.dims[2]; ++k) {
    gdcm::Writer writer;
    gdcm::DataSet& set = writer.GetFile().GetDataSet();
    describe(set, v, k, series);
    plant_patient(set);
    put_pixels(set, v, k, series.signed_pixels);
    writer.GetFile().GetHeader().SetDataSetTransferSyntax(
        gdcm::TransferSyntax::ExplicitVRLittleEndian);
    out.push_back(folder / fmt::format("{}{:04}.dcm", series.prefix, (k * 7919 + 13) % 9973));
    writer.SetFileName(out.back().c_str());
    core::require(writer.Write(), "a test's DICOM file can be written");
    if (series.transfer_syntax != "1.2.840.10008.1.2.1")
      change_syntax(out.back(), series.transfer_syntax);
  }
  return out;
}

fs::path write_enhanced_ct(const fs::path& path, const Volume& v, const std::vector<int>& slices,
                           const DicomSeries& series) {
  gdcm::Trace::WarningOff();
  const gdcm::TransferSyntax syntax(
      gdcm::TransferSyntax::GetTSType(series.transfer_syntax.c_str()));
  const fs::path classic = path.string() + ".classic";  // GDCM compresses there, slice by slice
  const auto files = write_dicom_series(classic, v, series);
  gdcm::Writer writer;
  gdcm::DataSet& set = writer.GetFile().GetDataSet();
  std::vector<gdcm::DataSet> groups;
  std::string plain;
  gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments = new gdcm::SequenceOfFragments;
  for (const int k : slices) {
    gdcm::DataSet own;
    describe(own, v, k, series);
    groups.push_back(own_group(own, series.slope_drift != 0.0));
    gdcm::Reader reader;
    reader.SetFileName(files[static_cast<std::size_t>(k)].c_str());
    core::require(reader.Read(), "what was just written can be read");
    const auto& pixels = reader.GetFile().GetDataSet().GetDataElement(gdcm::Tag(0x7fe0, 0x0010));
    if (syntax.IsEncapsulated()) {
      fragments->AddFragment(pixels.GetSequenceOfFragments()->GetFragment(0));
    } else {
      const gdcm::ByteValue* bytes = pixels.GetByteValue();
      plain.append(bytes->GetPointer(), bytes->GetLength());
    }
  }
  fs::remove_all(classic);
  describe(set, v, 0, series);
  const gdcm::DataSet common = shared_group(set, series.slope_drift == 0.0);
  own_group(set, false);
  text(set, 0x0008, 0x0016, gdcm::VR::UI, "1.2.840.10008.5.1.4.1.1.2.1");  // enhanced CT image
  text(set, 0x0028, 0x0008, gdcm::VR::IS, std::to_string(slices.size()));
  nest(set, 0x5200, 0x9229, {common});
  nest(set, 0x5200, 0x9230, groups);
  plant_patient(set);
  gdcm::DataElement pixels(gdcm::Tag(0x7fe0, 0x0010));
  pixels.SetVR(syntax.IsEncapsulated() ? gdcm::VR::OB : gdcm::VR::OW);
  if (syntax.IsEncapsulated())
    pixels.SetValue(*fragments);
  else
    pixels.SetByteValue(plain.data(), static_cast<std::uint32_t>(plain.size()));
  set.Replace(pixels);
  writer.GetFile().GetHeader().SetDataSetTransferSyntax(syntax);
  writer.SetFileName(path.c_str());
  core::require(writer.Write(), "a test's DICOM file can be written");
  return path;
}

}  // namespace test_support
}  // namespace tractus
