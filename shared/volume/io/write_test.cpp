/// Volumes and surfaces out, read back by others: zlib and the NRRD format's text, VTK's own STL
/// reader.
#include <gtest/gtest.h>
#include <vtkMassProperties.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSTLReader.h>
#include <zlib.h>

#include <cstring>
#include <numbers>
#include <string>

#include "core/file.hpp"
#include "tests/support/scratch.hpp"
#include "volume/io/read_volume.hpp"
#include "volume/io/write_nrrd.hpp"
#include "volume/io/write_surface.hpp"

namespace tractus {
namespace {
using test_support::Scratch;
using volume::Vec3;

/// 5 × 4 × 3 voxels, CT value 100 k + 10 j + i − 50, turned by 90° about z.
volume::Volume small_volume() {
  volume::Volume v;
  v.geometry.dims = {5, 4, 3};
  v.geometry.spacing_m = Vec3(0.7e-3, 0.8e-3, 1.25e-3);
  v.geometry.origin_m = Vec3(-71.5e-3, 12.25e-3, 0.3);
  v.geometry.directions.col(0) = Vec3(0, 1, 0);
  v.geometry.directions.col(1) = Vec3(-1, 0, 0);
  v.intercept = -50.0;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i) v.counts.push_back(std::uint16_t(100 * k + 10 * j + i));
  return v;
}

/// Signed distance to a ball of 6 mm as CT value: 1000 at the centre, 400 on the surface.
volume::Volume ball(double handedness) {
  volume::Volume v;
  v.geometry.dims = {41, 43, 45};
  v.geometry.spacing_m = Vec3(0.4e-3, 0.4e-3, 0.4e-3);
  v.geometry.directions.col(0) = Vec3(handedness, 0, 0);
  v.geometry.origin_m = Vec3(0.02, 0.1, -0.05);
  const Vec3 centre_m = v.geometry.position_of(Vec3(20, 21, 22));
  for (int k = 0; k < 45; ++k)
    for (int j = 0; j < 43; ++j)
      for (int i = 0; i < 41; ++i) {
        const double r_mm = (v.geometry.position_of(Vec3(i, j, k)) - centre_m).norm() * 1e3;
        v.counts.push_back(v.count_of(std::max(0.0, 1000.0 - 100.0 * r_mm)));
      }
  return v;
}

std::string inflated(const std::string& zipped, std::size_t expected) {
  std::string out(expected + 1, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 16 + MAX_WBITS), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zipped.data()));
  stream.avail_in = static_cast<uInt>(zipped.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  inflateEnd(&stream);
  return out;
}

TEST(WriteNrrd, ValuesAndPlaceAreInTheFileAsTheFormatSays) {
  const Scratch folder;
  ASSERT_TRUE(volume_io::write_nrrd(folder / "v.nrrd", small_volume()));
  const auto bytes = core::read_file(folder / "v.nrrd");
  ASSERT_TRUE(bytes);
  const std::string text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  const auto end = text.find("\n\n");
  ASSERT_NE(end, std::string::npos);
  const std::string header = text.substr(0, end + 1);
  for (const char* line :
       {"NRRD000", "type: short\n", "dimension: 3\n", "space: left-posterior-superior\n",
        "sizes: 5 4 3\n", "endian: little\n", "encoding: gzip\n",
        "space directions: (0,0.69999999999999996,0) (-0.80000000000000004,0,0) (0,0,1.25)\n",
        "space origin: (-71.5,12.25,300)\n", "space units: \"mm\" \"mm\" \"mm\"\n"})
    EXPECT_NE(header.find(line), std::string::npos) << line << "\n" << header;
  const std::string voxels = inflated(text.substr(end + 2), 5 * 4 * 3 * 2);
  ASSERT_EQ(voxels.size(), 5u * 4 * 3 * 2);
  std::int16_t value = 0;
  std::memcpy(&value, voxels.data() + 2 * (2 * 20 + 3 * 5 + 4), 2);  // (i, j, k) = (4, 3, 2)
  EXPECT_EQ(value, 200 + 30 + 4 - 50);
}

TEST(WriteNrrd, AReaderOfForeignFilesFindsTheSameVolume) {
  const Scratch folder;
  const auto v = small_volume();
  ASSERT_TRUE(volume_io::write_nrrd(folder / "v.nrrd", v));
  const auto in = volume_io::read_volume(folder / "v.nrrd");
  ASSERT_TRUE(in) << in.error().what;
  const Vec3 at(4, 3, 2);
  EXPECT_LT((in->volume.geometry.position_of(at) - v.geometry.position_of(at)).norm(), 1e-12);
  EXPECT_EQ(in->volume.value(4, 3, 2), 184);
}

TEST(WriteNrrd, ValuesThatAreNoWholeNumbersStayWithinFloat) {
  const Scratch folder;
  auto v = small_volume();
  v.slope = 0.25;
  ASSERT_TRUE(volume_io::write_nrrd(folder / "v.nrrd", v));
  const auto in = volume_io::read_volume(folder / "v.nrrd");
  ASSERT_TRUE(in) << in.error().what;
  EXPECT_NEAR(in->volume.value(4, 3, 2), -50 + 0.25 * 234, 1e-3);
}

TEST(WriteNrrd, SaysWhichFileCannotBeWritten) {
  const auto written = volume_io::write_nrrd("/nowhere/v.nrrd", small_volume());
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().what.find("/nowhere/v.nrrd"), std::string::npos);
}

vtkNew<vtkPolyData> surface_of(const std::filesystem::path& path) {
  vtkNew<vtkSTLReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkNew<vtkPolyData> out;
  out->ShallowCopy(reader->GetOutput());
  return out;
}

/// Volume, mm³; negative where normals point inwards. VTK's mass properties take the absolute
/// value, so the divergence theorem by hand.
double signed_volume_mm3(vtkPolyData* surface) {
  double six = 0.0;
  for (vtkIdType k = 0; k < surface->GetNumberOfCells(); ++k) {
    vtkNew<vtkIdList> ids;
    surface->GetCellPoints(k, ids);
    Vec3 a, b, c;
    surface->GetPoint(ids->GetId(0), a.data());
    surface->GetPoint(ids->GetId(1), b.data());
    surface->GetPoint(ids->GetId(2), c.data());
    six += a.dot(b.cross(c));
  }
  return six / 6.0;
}

TEST(WriteSurface, ABallHasItsVolumeAndPlaceWhicheverHandTheVolumeHas) {
  for (const double hand : {1.0, -1.0}) {
    const Scratch folder;
    const auto v = ball(hand);
    const auto triangles = volume_io::write_bone_stl(folder / "b.stl", v, 400.0);
    ASSERT_TRUE(triangles) << triangles.error().what;
    const auto surface = surface_of(folder / "b.stl");
    // A binary STL has 84 bytes before its triangles of 50 bytes; VTK's reader drops flat ones.
    EXPECT_EQ(std::filesystem::file_size(folder / "b.stl"), 84 + 50 * *triangles);
    EXPECT_GT(surface->GetNumberOfCells(), 5000);
    const double ball_mm3 = 4.0 / 3.0 * std::numbers::pi * 6.0 * 6.0 * 6.0;  // 904.8
    EXPECT_NEAR(signed_volume_mm3(surface), ball_mm3, 0.01 * ball_mm3) << "hand " << hand;
    const Vec3 centre_mm = v.geometry.position_of(Vec3(20, 21, 22)) * 1e3;
    const double* box = surface->GetBounds();
    for (int a = 0; a < 3; ++a) EXPECT_NEAR((box[2 * a] + box[2 * a + 1]) / 2, centre_mm[a], 0.02);
  }
}

TEST(WriteSurface, AValueThatNoVoxelHasIsRefused) {
  const Scratch folder;
  const auto written = volume_io::write_bone_stl(folder / "b.stl", ball(1.0), 3000.0);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().what, "no surface lies at the CT value 3000");
}

TEST(WriteSurface, ATractIsACylinderOfItsRadius) {
  const Scratch folder;
  volume::Tract tract;
  tract.entry_m = Vec3(0.046, 0.2, -0.061);
  tract.axis = Vec3(-1, -5, 0).normalized();
  tract.length_m = 0.04;
  tract.radius_m = 0.0015;
  ASSERT_TRUE(volume_io::write_tract_stl(folder / "t.stl", tract));
  vtkNew<vtkMassProperties> mass;
  mass->SetInputData(surface_of(folder / "t.stl"));
  // A prism of 48 sides in a circle of 1.5 mm: n/2 r² sin(2π/n) · 40 mm.
  const double prism_mm3 = 24 * 1.5 * 1.5 * std::sin(2 * std::numbers::pi / 48) * 40;
  EXPECT_NEAR(mass->GetVolume(), prism_mm3, 0.01 * prism_mm3);
}

}  // namespace
}  // namespace tractus
