#include "target.hpp"

#include <unistd.h>

#include <algorithm>
#include <checkout.hpp>
#include <fstream>

#include "core/file.hpp"

namespace tractus::fuzz {
namespace fs = std::filesystem;

std::vector<core::Bytes> seeds_of(const Target& target) {
  const fs::path root(checkout::kSource);
  std::vector<fs::path> files;
  for (const auto& seed : target.seeds) files.push_back(root / seed);
  const fs::path corpus = root / "tests/fuzz/corpora" / target.name;
  if (fs::exists(corpus))
    for (const auto& entry : fs::directory_iterator(corpus)) files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<core::Bytes> out;
  for (const auto& file : files) out.push_back(core::read_file(file).value());
  return out;
}

const fs::path& scratch() {
  static const struct Folder {
    fs::path path = (fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) /
                    ("tractus_fuzz_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  } folder;
  return folder.path;
}

fs::path placed(const std::string& name, core::ByteView bytes) {
  const fs::path path = scratch() / name;
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  return path;
}

}  // namespace tractus::fuzz
