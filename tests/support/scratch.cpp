#include "tests/support/scratch.hpp"

#include <zlib.h>

#include <algorithm>
#include <fstream>

#include "core/require.hpp"

namespace tractus {
namespace test_support {
namespace fs = std::filesystem;
namespace {

void add(gzFile file, core::ByteView bytes) {
  if (bytes.empty()) return;
  const int written = gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  core::require(written == static_cast<int>(bytes.size()), "a test's file can be written");
}

}  // namespace

Scratch::Scratch() {
  std::string name = (fs::temp_directory_path() / "tractus-test-XXXXXX").string();
  core::require(::mkdtemp(name.data()) != nullptr, "a test's folder can be made");
  path_ = name;
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::size_t Scratch::entries() const {
  return static_cast<std::size_t>(std::distance(fs::recursive_directory_iterator(path_), {}));
}

void put(const fs::path& path, core::ByteView bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  file.close();
  core::require(file.good(), "a test's file can be written");
}

void put_gzip(const fs::path& path, core::ByteView bytes) {
  gzFile file = gzopen(path.c_str(), "wb");
  core::require(file != nullptr, "a test's file can be made");
  add(file, bytes);
  gzclose(file);
}

void put_gzip_of_zeros(const fs::path& path, core::ByteView start, std::uint64_t size) {
  gzFile file = gzopen(path.c_str(), "wb1");
  core::require(file != nullptr, "a test's file can be made");
  add(file, start);
  const core::Bytes zeros(1u << 20);
  for (; size > 0; size -= std::min<std::uint64_t>(size, zeros.size()))
    add(file, core::ByteView(zeros).first(std::min<std::uint64_t>(size, zeros.size())));
  gzclose(file);
}

}  // namespace test_support
}  // namespace tractus
