/// `tractus import` and `tractus info` as a person runs them: real CTs, a DICOM series with a
/// patient planted, and files that mean harm. Each bad one ends with exit 2, one line, nothing left
/// behind and little memory taken.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstring>
#include <functional>

#include "core/file.hpp"
#include "core/json.hpp"
#include "tests/support/dicom_writer.hpp"
#include "tests/support/scratch.hpp"
#include "volume/volume_file.hpp"

namespace tractus {
namespace {
using test_support::put;
using test_support::Scratch;
namespace fs = std::filesystem;

const fs::path kCts = fs::path(checkout::kSource) / "tests/data/ct";
const fs::path kL3 = kCts / "tptbox_L3/sub-ct_label-22_ct.nii.gz";

struct Ended {
  int exit = -1;
  std::string out, err;
  long peak_kB = 0;  ///< largest resident memory of the program or its children
};

std::string text_of(const fs::path& path) {
  return std::string(core::text_of(core::read_file(path).value()));
}

Ended tractus(const std::vector<std::string>& arguments) {
  const Scratch folder;
  const std::string program = std::string(checkout::kBin) + "/tractus";
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const std::string out = folder / "out", err = folder / "err";
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    ::unsetenv("DISPLAY");
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }
  int status = 0;
  rusage used{};
  EXPECT_EQ(::wait4(child, &status, 0, &used), child);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err), used.ru_maxrss};
}

TEST(Import, TheThreeCtsBecomeVolumesAndPictures) {
  const Scratch folder;
  for (const char* ct :
       {"tptbox_L3/sub-ct_label-22_ct.nii.gz", "totalseg_lumbar_pelvis/example_ct.nii.gz",
        "totalseg_thorax_cta/ct_cropped.nii.gz"}) {
    const Ended import = tractus({"import", kCts / ct, folder / "v.tvol", "--json"});
    ASSERT_EQ(import.exit, 0) << import.err;
    EXPECT_EQ(import.err, "");
    const auto made = core::parse_json(import.out, "import");
    ASSERT_TRUE(made);
    const Ended info = tractus({"info", folder / "v.tvol", "--json", "--png", folder / "v.png"});
    ASSERT_EQ(info.exit, 0) << info.err;
    const auto told = core::parse_json(info.out, "info");
    ASSERT_TRUE(told);
    EXPECT_EQ((*told)["id"], (*made)["id"]);
    EXPECT_EQ((*told)["dims"], (*made)["dims"]);
    EXPECT_TRUE(text_of(folder / "v.png").starts_with("\x89PNG\r\n"));
  }
}

TEST(Import, ADicomSeriesOfTheL3GivesTheVoxelsOfItsNiftiAndNothingOfThePatient) {
  const Scratch folder;
  ASSERT_EQ(tractus({"import", kL3, folder / "nifti.tvol"}).exit, 0);
  const auto stored = volume::VolumeFile::open(folder / "nifti.tvol");
  ASSERT_TRUE(stored);
  const auto l3 = stored->read_all();
  ASSERT_TRUE(l3);
  test_support::write_dicom_series(folder / "series", *l3,
                                   {.transfer_syntax = "1.2.840.10008.1.2.4.80"});
  const Ended import = tractus({"import", folder / "series", folder / "dicom.tvol"});
  ASSERT_EQ(import.exit, 0) << import.err;
  const auto file = volume::VolumeFile::open(folder / "dicom.tvol");
  ASSERT_TRUE(file);
  const auto back = file->read_all();
  ASSERT_TRUE(back);
  // The L3's axes P, I, R are right-handed, so slices keep their order.
  EXPECT_EQ(back->geometry.dims, l3->geometry.dims);
  EXPECT_LT((back->geometry.origin_m - l3->geometry.origin_m).norm(), 1e-8);
  EXPECT_LT((back->geometry.directions - l3->geometry.directions).norm(), 1e-6);
  for (std::size_t n = 0; n < l3->counts.size(); ++n)
    ASSERT_EQ(back->intercept + back->slope * back->counts[n],
              l3->intercept + l3->slope * l3->counts[n]);
  const std::string bytes = text_of(folder / "dicom.tvol");
  std::string series;
  for (const auto& slice : fs::directory_iterator(folder / "series"))
    series += text_of(slice.path());
  for (const std::string& planted : test_support::kPlantedTexts) {
    EXPECT_NE(series.find(planted), std::string::npos) << planted;
    EXPECT_EQ(bytes.find(planted), std::string::npos) << planted;
    EXPECT_EQ(import.out.find(planted), std::string::npos) << planted;
  }
}

TEST(Import, InfoTellsAPersonMillimetresAndAHistogram) {
  const Ended info = tractus({"info", kL3});
  ASSERT_EQ(info.exit, 0) << info.err;
  for (const char* word : {"73 x 47 x 73", "axes run to PIR", "1.5 x 1.5 x 1.5 mm",
                           "109.5 x 70.5 x 109.5 mm", "-1030 to 1961", "####"})
    EXPECT_NE(info.out.find(word), std::string::npos) << word << "\n" << info.out;
}

TEST(Import, HelpEndsWithAnExample) {
  for (const char* command : {"import", "info"}) {
    const Ended help = tractus({command, "--help"});
    EXPECT_EQ(help.exit, 0);
    EXPECT_NE(help.out.find(std::string("Example:\n  tractus ") + command), std::string::npos)
        << help.out;
  }
}

TEST(Import, APictureOutsideTheVolumeOrIntoNoFolderIsRefused) {
  const Scratch folder;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"info", kL3, "--png", folder / "p.png", "--at", "0,0,0"},
        std::vector<std::string>{"info", kL3, "--png", folder / "no/p.png"},
        std::vector<std::string>{"import", kL3, folder / "no/v.tvol"},
        std::vector<std::string>{"import", folder / "nothing.nii", folder / "v.tvol"}}) {
    const Ended run = tractus(wrong);
    EXPECT_EQ(run.exit, 2);
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  }
  EXPECT_EQ(folder.entries(), 0u);
}

/// A NIfTI-1 header of one int16 volume in mm, sform identity; fields as nifti1.h places them.
core::Bytes nifti(std::array<std::int16_t, 3> dims, std::size_t voxel_bytes, float spacing = 1.0f) {
  core::Bytes out(352 + voxel_bytes);
  const auto set = [&]<class T>(std::size_t at, T value) {
    std::memcpy(out.data() + at, &value, sizeof(T));
  };
  set(0, std::int32_t{348});
  set(40, std::int16_t{3});
  for (std::size_t a = 0; a < 3; ++a) {
    set(42 + 2 * a, dims[a]);
    set(280 + 20 * a, spacing);
  }
  set(70, std::int16_t{4});
  set(108, 352.0f);
  set(123, char{2});
  set(254, std::int16_t{1});
  std::memcpy(out.data() + 344, "n+1", 4);
  return out;
}

std::string nrrd(const std::string& sizes, const std::string& encoding,
                 const std::string& more = "") {
  return "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: " + sizes +
         "\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nendian: "
         "little\nencoding: " +
         encoding + "\n" + more + "\n";
}

struct Hostile {
  const char* name;
  std::function<fs::path(const Scratch&)> make;  ///< returns what to import
  const char* word;                              ///< in the message, beside the file's name
};

class HostileImport : public testing::TestWithParam<Hostile> {};

TEST_P(HostileImport, EndsWithOneLineAndNothingLeftInLittleMemory) {
  const Scratch input, output;
  const fs::path source = GetParam().make(input);
  const Ended run = tractus({"import", source, output / "v.tvol"});
  EXPECT_EQ(run.exit, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(source.filename().string()), std::string::npos) << run.err;
  EXPECT_NE(run.err.find(GetParam().word), std::string::npos) << run.err;
  EXPECT_EQ(output.entries(), 0u);
  EXPECT_LT(run.peak_kB, 512 * 1024);
}

fs::path file(const Scratch& folder, const char* name, core::ByteView bytes) {
  put(folder / name, bytes);
  return folder / name;
}

const auto kBytes = [](const std::string& text) { return core::bytes_of(text); };

fs::path spoilt_series(const Scratch& folder, const std::function<void(core::Bytes&)>& spoil) {
  volume::Volume v;
  v.geometry.dims = {16, 16, 4};
  v.geometry.spacing_m = volume::Vec3::Constant(1e-3);
  v.counts.assign(v.geometry.voxel_count(), 7);
  const auto files = test_support::write_dicom_series(folder / "series", v);
  core::Bytes bytes = core::read_file(files[1]).value();
  spoil(bytes);
  put(files[1], bytes);
  return folder / "series";
}

/// Sets `with` so many bytes after the tag's first place.
void overwrite(core::Bytes& bytes, std::array<unsigned char, 4> tag, std::ptrdiff_t skip,
               std::vector<unsigned char> with) {
  const auto wanted = std::as_bytes(std::span(tag));
  const auto at = std::search(bytes.begin() + 132, bytes.end(), wanted.begin(), wanted.end());
  std::ranges::transform(with, at + skip, [](unsigned char b) { return std::byte{b}; });
}

INSTANTIATE_TEST_SUITE_P(
    All, HostileImport,
    testing::Values(
        Hostile{"NiftiTruncated",
                [](const Scratch& f) {
                  return file(f, "v.nii", core::ByteView(nifti({64, 64, 64}, 1000)));
                },
                "has 1352 bytes"},
        Hostile{"NiftiNegative",
                [](const Scratch& f) {
                  return file(f, "v.nii", core::ByteView(nifti({-64, 64, 64}, 1000)));
                },
                "dim: axis 1"},
        Hostile{"NiftiHuge",
                [](const Scratch& f) {
                  return file(f, "v.nii", core::ByteView(nifti({32767, 32767, 32767}, 1000)));
                },
                "dim: axis 1"},
        Hostile{"NiftiNanSpacing",
                [](const Scratch& f) {
                  return file(f, "v.nii", core::ByteView(nifti({2, 2, 2}, 16, NAN)));
                },
                "sform"},
        Hostile{"NiftiWrongSize",
                [](const Scratch& f) {
                  return file(f, "v.nii", core::ByteView(nifti({2, 2, 2}, 999)));
                },
                "its header declares 368"},
        Hostile{"TextRenamed",
                [](const Scratch& f) { return file(f, "v.nii", kBytes("not a volume at all\n")); },
                "no NIfTI"},
        Hostile{"EmptyFile", [](const Scratch& f) { return file(f, "v.nii.gz", {}); }, "no NIfTI"},
        Hostile{"GzipBombSmallHeader",
                [](const Scratch& f) {
                  test_support::put_gzip_of_zeros(f / "v.nii.gz", nifti({2, 2, 2}, 16), 1ull << 30);
                  return f / "v.nii.gz";
                },
                "inflates to more than"},
        Hostile{"GzipBombHugeHeader",
                [](const Scratch& f) {
                  test_support::put_gzip_of_zeros(f / "v.nii.gz", nifti({1200, 1200, 1100}, 0),
                                                  64u << 20);
                  return f / "v.nii.gz";
                },
                "which no CT reaches"},
        Hostile{"GzipGarbage",
                [](const Scratch& f) {
                  return file(f, "v.nii.gz",
                              kBytes("\x1f\x8b\x08"
                                     "garbage and more garbage"));
                },
                "gzip stream is damaged"},
        Hostile{"NrrdBillions",
                [](const Scratch& f) {
                  return file(f, "v.nrrd", kBytes(nrrd("1000000000 1000000000 1000000000", "raw")));
                },
                "sizes: axis 1"},
        Hostile{"NrrdTruncated",
                [](const Scratch& f) {
                  return file(f, "v.nrrd", kBytes(nrrd("500 500 500", "raw") + "12345"));
                },
                "its header declares"},
        Hostile{"NrrdPasswords",
                [](const Scratch& f) {
                  return file(f, "v.nhdr",
                              kBytes(nrrd("2 2 2", "raw", "data file: ../../etc/passwd\n")));
                },
                "within the header's own folder"},
        Hostile{"NrrdMissingData",
                [](const Scratch& f) {
                  return file(f, "v.nhdr", kBytes(nrrd("2 2 2", "raw", "data file: gone.raw\n")));
                },
                "there is no such file"},
        Hostile{"NrrdEndlessHeader",
                [](const Scratch& f) {
                  return file(f, "v.nrrd", kBytes("NRRD0004\n" + std::string(10u << 20, '#')));
                },
                "64 KiB"},
        Hostile{"DicomLyingLength",
                [](const Scratch& f) {
                  return spoilt_series(f, [](auto& b) {
                    overwrite(b, {0xe0, 0x7f, 0x10, 0}, 8, {0xf0, 0xff, 0xff, 0x7f});
                  });
                },
                "declares 2147483632 bytes"},
        Hostile{"DicomLyingRows",
                [](const Scratch& f) {
                  return spoilt_series(f, [](auto& b) {
                    overwrite(b, {0x28, 0, 0x10, 0}, 8, {0xff, 0x0f});
                  });
                },
                "4095 rows"},
        Hostile{"DicomTruncated",
                [](const Scratch& f) {
                  return spoilt_series(f, [](auto& b) { b.resize(b.size() - 100); });
                },
                "are left"},
        Hostile{"EmptyFolder",
                [](const Scratch& f) {
                  fs::create_directory(f / "series");
                  return f / "series";
                },
                "no DICOM file"},
        Hostile{"TvolTruncated",
                [](const Scratch& f) {
                  return file(f, "v.tvol",
                              kBytes(std::string("TRACTVOL\1\0\0\0\377\377\377\177", 16)));
                },
                "header of"}),
    [](const auto& named) { return std::string(named.param.name); });

}  // namespace
}  // namespace tractus
