/// What objects in an S3 bucket cost against the folder: the last step of an upload, which puts the
/// finished file among the objects and after which it is acknowledged; the whole, with the file
/// written and flushed before; and a read of an object that the folder has no more. The folder and the bucket take turns on the same files. The server is
/// Ceph's RADOS gateway with one OSD in memory on this machine, or with --objects ADDRESS any other.
#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <thread>

#include "bench/support/report.hpp"
#include "core/file.hpp"
#include "core/require.hpp"
#include "db/store/volumes/objects.hpp"
#include "db/store/volumes/s3_store.hpp"
#include "tests/support/s3/s3_server.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;

struct Sizes {
  const char* what;
  std::size_t size_bytes;
  int files;
};

/// One place where objects are kept, and the seconds that each file took there.
struct Place {
  const char* name;
  store::Objects objects;
  std::vector<double> put_s = {}, whole_s = {}, read_s = {};
};

double put(Place& place, const fs::path& file, const std::string& sha256) {
  const double start = bench::wall_s();
  const auto linked = place.objects.link_in(file, sha256);
  core::require(bool(linked), "an object is put");
  return bench::wall_s() - start;
}

/// From the bucket: the folder's copy is gone. From the folder: the system has it in its memory.
double read(Place& place, const std::string& sha256, bool fetched) {
  if (fetched) fs::remove(place.objects.path_of(sha256));
  const double start = bench::wall_s();
  const auto path = place.objects.file(sha256);
  core::require(bool(path) && store::file_sha256(*path).value() == sha256, "an object is read");
  return bench::wall_s() - start;
}

void run(const Sizes& sizes, Place& folder, Place& bucket, const fs::path& scratch,
         bench::Report& report) {
  for (Place* place : {&folder, &bucket}) place->put_s = place->whole_s = place->read_s = {};
  for (int i = 0; i < sizes.files; ++i) {
    const core::Bytes bytes = core::random_bytes(sizes.size_bytes);
    const std::string sha256 = core::sha256(bytes);
    const fs::path file = scratch / "upload.part";
    const double start = bench::wall_s();
    core::require(bool(core::write_file(file, bytes)), "a file is made");
    const double received_s = bench::wall_s() - start;
    for (Place* place : {&folder, &bucket}) {
      place->put_s.push_back(put(*place, file, sha256));
      place->whole_s.push_back(received_s + place->put_s.back());
      place->read_s.push_back(read(*place, sha256, place == &bucket));
      core::require(bool(place->objects.remove(sha256)), "an object is removed");
    }
    fs::remove(file);
  }
  for (Place* place : {&folder, &bucket}) {
    const std::string what = fmt::format("{}, {}", place->name, sizes.what);
    report.row("acknowledged, median, " + what, 1e3 * bench::quantile(place->put_s, 0.5), "ms");
    report.row("acknowledged, 99 %, " + what, 1e3 * bench::quantile(place->put_s, 0.99), "ms");
    const double whole_s = bench::quantile(place->whole_s, 0.5);
    report.row("whole upload, " + what, 1e-6 * double(sizes.size_bytes) / whole_s, "MB/s");
    const double read_s = bench::quantile(place->read_s, 0.5);
    report.row("read, " + what, 1e-6 * double(sizes.size_bytes) / read_s, "MB/s");
  }
}

/// The value of --objects; empty: none.
std::string address_in(int argc, char** argv) {
  for (int i = 1; i + 1 < argc; ++i)
    if (std::string_view(argv[i]) == "--objects") return argv[i + 1];
  return {};
}

}  // namespace
}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("object_store: finished files acknowledged and read, folder and S3 bucket");
  std::string address = address_in(argc, argv);
  if (address.empty()) address = test_support::s3_server().address("bench");
  const fs::path scratch = fs::temp_directory_path() / ("tractus-objects-" + core::new_id());
  fs::create_directories(scratch / "cache");
  auto beyond = store::open_s3(store::S3Address::parse(address).value(),
                               store::S3Credentials::find().value());
  Place folder{"folder", std::move(store::Objects::open(scratch).value())};
  Place bucket{"bucket",
               std::move(store::Objects::open(scratch / "cache", std::move(beyond)).value())};
  for (const Sizes& sizes :
       {Sizes{"trial of 1 MB", 1'000'000, 200}, Sizes{"trial of 12 MB", 12'000'000, 20},
        Sizes{"volume of 200 MB", 200'000'000, 3}})
    run(sizes, folder, bucket, scratch, report);
  fs::remove_all(scratch);
  return report.finish(argc, argv);
}
