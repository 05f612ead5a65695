/// Volumes over the API: brought, held, looked at, released or refused; and nothing of the patient
/// anywhere the server keeps things.
#include <archive.h>
#include <archive_entry.h>

#include <fstream>
#include <set>

#include "core/file.hpp"
#include "server/api/people/people_test_support.hpp"
#include "tests/support/dicom_writer.hpp"
#include "tests/support/nifti_file.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace api {
namespace {
namespace fs = std::filesystem;
using testing::PeopleTest;
using volume::Vec3;

/// Simulated: CT value 100 i + 10 j + k, 20 × 16 × 12 voxels of 1, 2 and 3 mm, upright.
volume::Volume ramp() {
  volume::Volume v;
  v.geometry.dims = {20, 16, 12};
  v.geometry.spacing_m = {1e-3, 2e-3, 3e-3};
  v.geometry.origin_m = {-0.01, 0.02, 0.1};
  v.intercept = -1024.0;
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 16; ++j)
      for (int i = 0; i < 20; ++i)
        v.counts.push_back(static_cast<std::uint16_t>(1024 + 100 * i + 10 * j + k));
  return v;
}

std::string zip_of(const std::map<std::string, std::string>& files) {
  std::string out(64u << 20, '\0');
  std::size_t used = 0;
  archive* writer = archive_write_new();
  archive_write_set_format_zip(writer);
  EXPECT_EQ(archive_write_open_memory(writer, out.data(), out.size(), &used), ARCHIVE_OK);
  for (const auto& [name, bytes] : files) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    EXPECT_EQ(archive_write_header(writer, entry), ARCHIVE_OK);
    EXPECT_EQ(archive_write_data(writer, bytes.data(), bytes.size()),
              static_cast<la_ssize_t>(bytes.size()));
    archive_entry_free(entry);
  }
  EXPECT_EQ(archive_write_close(writer), ARCHIVE_OK);
  archive_write_free(writer);
  out.resize(used);
  return out;
}

std::string bytes_of_file(const fs::path& path) {
  const auto bytes = core::read_file(path);
  return bytes ? std::string(core::text_of(*bytes)) : std::string();
}

class Volumes : public PeopleTest {
 protected:
  std::string series_zip(const volume::Volume& v) {
    const fs::path folder = folder_.path() / "series";
    std::map<std::string, std::string> files;
    for (const auto& path : test_support::write_dicom_series(folder, v))
      files["Mustermann^Erika/" + path.filename().string()] = bytes_of_file(path);
    files["Mustermann^Erika/readme.txt"] = "Mustermann^Erika";
    fs::remove_all(folder);
    return zip_of(files);
  }
  http::Response bring(const std::string& account, const std::string& body) {
    auto headers = as(account);
    headers["content-type"] = "application/octet-stream";
    return ask(request("POST", "/api/v1/volumes?name=L3&source=test", headers, body));
  }
  std::string brought(const std::string& body) {
    const auto answer = bring("fay", body);
    EXPECT_EQ(answer.status, 201) << text(answer);
    return json(answer).value("id", "");
  }
};

TEST_F(Volumes, ADicomZipIsHeldUntilADirectorHasLookedAtIt) {
  const std::string id = brought(series_zip(ramp()));
  const auto shown = json(get("rex", "/volumes"))["volumes"][0];
  EXPECT_EQ(shown["state"], "held");
  EXPECT_EQ(shown["modality"], "CT");
  EXPECT_EQ(shown["dims"], core::Json({20, 16, 12}));
  EXPECT_EQ(shown["made_by"], "fay");
  EXPECT_EQ(get("rex", "/volumes/" + id + "/slice?axis=axial").status, 403);
  EXPECT_EQ(get("fay", "/volumes/" + id + "/slice?axis=axial").status, 200);  // she brought it
  EXPECT_EQ(get("dora", "/volumes/" + id + "/slice?axis=axial").status, 200);
  EXPECT_EQ(post("fay", "/volumes/" + id + "/release", {{"looked_at", true}}).status, 403);
  EXPECT_EQ(post("dora", "/volumes/" + id + "/release", {{"looked_at", false}}).status, 400);
  const auto released = post("dora", "/volumes/" + id + "/release", {{"looked_at", true}});
  ASSERT_EQ(released.status, 200) << text(released);
  EXPECT_EQ(json(released)["released_by"], "dora");
  EXPECT_EQ(get("rex", "/volumes/" + id + "/slice?axis=axial").status, 200);
  EXPECT_EQ(post("dora", "/volumes/" + id + "/refuse", {{"reason", "late"}}).status, 409);
  EXPECT_EQ(get("tom", "/volumes").status, 403);
}

TEST_F(Volumes, ARefusedVolumeLeavesNoVoxelBehind) {
  const std::string id = brought(series_zip(ramp()));
  ASSERT_EQ(post("dora", "/volumes/" + id + "/refuse", {{"reason", "a face"}}).status, 200);
  EXPECT_EQ(get("dora", "/volumes/" + id + "/preview").status, 409);
  EXPECT_EQ(json(get("dora", "/volumes/" + id))["reason"], "a face");
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path() / "objects"))
    EXPECT_NE(bytes_of_file(entry.path()).substr(0, 8), "TRACTVOL") << entry.path();
  EXPECT_NE(brought(series_zip(ramp())), id);  // and may come again
}

TEST_F(Volumes, TheSameVoxelsAreNotHeldTwice) {
  brought(series_zip(ramp()));
  EXPECT_EQ(bring("fay", series_zip(ramp())).status, 409);
}

TEST_F(Volumes, SlicesLieWhereTheySay) {
  const std::string id = brought(series_zip(ramp()));
  // Axial through voxel k = 4: z = 0.1 + 4 · 3 mm. Pixels are as fine as the finest voxel, 1 mm:
  // 20 wide, 15 · 2 mm / 1 mm + 1 = 31 high. Window 0 … 2550: grey is a tenth of the CT value.
  const auto axial = get("dora", "/volumes/" + id + "/slice?axis=axial&at_m=0.112&low=0&high=2550");
  ASSERT_EQ(axial.status, 200) << text(axial);
  EXPECT_EQ(axial.header("X-Dims"), "20,31");
  EXPECT_EQ(axial.header("X-Directions"), "1,0,0,0,1,0");
  const std::string pixels = text(axial);
  ASSERT_EQ(pixels.size(), 20u * 31u);
  for (int row = 0; row < 31; ++row)
    for (int column = 0; column < 20; ++column) {
      const double value = 100 * column + 10 * (row / 2.0) + 4;  // j = row / 2
      EXPECT_NEAR(static_cast<unsigned char>(pixels[std::size_t(row * 20 + column)]), value / 10,
                  0.51)
          << row << ' ' << column;
    }
  // Coronal through j = 3 (y = 0.02 + 6 mm): the head is at the top, z falls with the row.
  const auto coronal =
      get("dora", "/volumes/" + id + "/slice?axis=coronal&at_m=0.026&low=0&high=2550");
  ASSERT_EQ(coronal.status, 200) << text(coronal);
  EXPECT_EQ(coronal.header("X-Dims"), "20,34");  // 11 · 3 mm
  EXPECT_EQ(coronal.header("X-Directions"), "1,0,0,-0,-0,-1");
  // First row: k = 11, i = 5: 500 + 30 + 11 = 541.
  EXPECT_NEAR(static_cast<unsigned char>(text(coronal)[5]), 54.1, 0.51);
  EXPECT_EQ(get("dora", "/volumes/" + id + "/slice?axis=axial&at_m=0.2").status, 400);
  EXPECT_EQ(get("dora", "/volumes/" + id + "/slice?axis=up").status, 400);
}

TEST_F(Volumes, ThePreviewIsTheMeanOfBlocks) {
  const std::string id = brought(series_zip(ramp()));
  const auto block = get("dora", "/volumes/" + id + "/preview?max_side=10&low=0&high=2550");
  ASSERT_EQ(block.status, 200) << text(block);
  EXPECT_EQ(block.header("X-Dims"), "10,8,6");
  // Block (1, 2, 3): i 2 … 3, j 4 … 5, k 6 … 7: 100 · 2.5 + 10 · 4.5 + 6.5 = 301.5.
  EXPECT_NEAR(static_cast<unsigned char>(text(block)[(3 * 8 + 2) * 10 + 1]), 30.15, 0.51);
}

TEST_F(Volumes, OfTwoSeriesInAZipTheCallerChoosesOne) {
  volume::Volume thick = ramp();
  thick.geometry.spacing_m.z() = 6e-3;
  const fs::path folder = folder_.path() / "series";
  std::map<std::string, std::string> files;
  for (const auto& [volume, uid] : {std::pair{ramp(), "2.25.3"}, std::pair{thick, "2.25.6"}})
    for (const auto& path :
         test_support::write_dicom_series(folder, volume, {.series_uid = uid, .prefix = uid}))
      files["Mustermann^Erika/" + path.filename().string()] = bytes_of_file(path);
  const std::string zip = zip_of(files);
  auto headers = as("fay");
  headers["content-type"] = "application/octet-stream";
  const auto bring_one = [&](const std::string& uid) {
    return ask(request("POST", "/api/v1/volumes?name=L3&series_uid=" + uid, headers, zip));
  };

  const auto none = bring("fay", zip);
  EXPECT_EQ(none.status, 400);
  for (const char* word : {"the upload: holds 2 series", "2.25.3 (CT, 12 slices", "spacing 6 mm"})
    EXPECT_NE(text(none).find(word), std::string::npos) << text(none);
  EXPECT_EQ(text(none).find("Mustermann"), std::string::npos) << text(none);
  EXPECT_NE(text(bring_one("2.25.4")).find("holds no series 2.25.4; it holds 2.25.3 ("),
            std::string::npos);
  EXPECT_NE(text(bring_one("a%20b")).find("series_uid: digits and dots"), std::string::npos);

  const auto taken = bring_one("2.25.6");
  ASSERT_EQ(taken.status, 201) << text(taken);
  EXPECT_NEAR(json(taken)["spacing_m"][2].get<double>(), 6e-3, 1e-9);
  EXPECT_EQ(json(taken)["notes"], core::Json({"12 files of other series were left out"}));
}

TEST_F(Volumes, AZippedNiftiIsRead) {
  const core::Bytes nifti = test_support::plain_nifti().bytes;
  const std::string file(core::text_of(nifti));
  const std::string id = brought(zip_of({{"Erika/ct.nii", file}, {"Erika/readme.txt", "Erika"}}));
  const core::Json shown = json(get("fay", "/volumes/" + id));
  EXPECT_EQ(shown["dims"], core::Json({5, 4, 3}));  // of nifti_file.hpp
  EXPECT_EQ(text(get("fay", "/volumes/" + id)).find("Erika"), std::string::npos);
}

TEST_F(Volumes, AZipOfTwoVolumesIsRefused) {
  const core::Bytes nifti = test_support::plain_nifti().bytes;
  const std::string file(core::text_of(nifti));
  const auto answer = bring("fay", zip_of({{"a.nii", file}, {"b.nii", file}}));
  EXPECT_EQ(answer.status, 400) << text(answer);
  EXPECT_NE(text(answer).find("several volumes"), std::string::npos) << text(answer);
}

TEST_F(Volumes, RubbishIsRefusedAndLeavesNothing) {
  for (const std::string& rubbish :
       {std::string(), std::string("hello"), std::string("PK\x03\x04 no zip at all"),
        zip_of({{"a.txt", "no DICOM"}}), zip_of({})}) {
    const auto answer = bring("fay", rubbish);
    EXPECT_EQ(answer.status, 400) << text(answer);
    EXPECT_EQ(text(answer).find(folder_.path().string()), std::string::npos) << text(answer);
  }
  EXPECT_EQ(json(get("dora", "/volumes"))["volumes"].size(), 0u);
  EXPECT_TRUE(fs::is_empty(folder_.path() / "uploads"));
}

TEST_F(Volumes, AZipBombIsRefusedWithoutBeingUnpackedWhole) {
  // 200 MiB of zeros in a DICOM file's clothes: a zip of about 0.2 MiB.
  std::string file(200u << 20, '\0');
  file.replace(128, 4, "DICM");
  const auto answer = bring("fay", zip_of({{"bomb.dcm", file}}));
  EXPECT_EQ(answer.status, 413) << text(answer);
  EXPECT_NE(text(answer).find("64 MiB"), std::string::npos) << text(answer);
}

}  // namespace
}  // namespace api
}  // namespace tractus
