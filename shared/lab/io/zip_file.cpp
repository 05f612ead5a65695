#include "lab/io/zip_file.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <fmt/format.h>

#include <fstream>

namespace tractus {
namespace lab_io {
namespace {

constexpr std::streamsize kZipPiece_bytes = 256 << 10;

struct FreesArchive {
  void operator()(archive* writer) const { archive_write_free(writer); }
};

struct ZipOutput {
  std::ofstream file;
  std::uint64_t most_bytes = 0;
  std::uint64_t size = 0;
};

la_ssize_t append_to_file(archive*, void* into, const void* bytes, size_t size) {
  auto& out = *static_cast<ZipOutput*>(into);
  out.size += size;
  if (out.size > out.most_bytes) return -1;
  out.file.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  return out.file ? static_cast<la_ssize_t>(size) : -1;
}

}  // namespace

struct ZipFile::Parts {
  ZipOutput out;
  std::unique_ptr<archive, FreesArchive> writer;

  bool begin(const std::string& name, std::uint64_t size) const {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(size));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    const bool begun = archive_write_header(writer.get(), entry) == ARCHIVE_OK;
    archive_entry_free(entry);
    return begun;
  }
  bool write(std::string_view bytes) const {
    return archive_write_data(writer.get(), bytes.data(), bytes.size()) ==
           static_cast<la_ssize_t>(bytes.size());
  }
};

ZipFile::ZipFile(const std::filesystem::path& path, std::uint64_t most_bytes)
    : parts_(new Parts{{std::ofstream(path, std::ios::binary), most_bytes}, {}}) {
  parts_->writer.reset(archive_write_new());
  archive_write_set_format_zip(parts_->writer.get());
  archive_write_set_bytes_in_last_block(parts_->writer.get(), 1);
  archive_write_open(parts_->writer.get(), &parts_->out, nullptr, append_to_file, nullptr);
}

ZipFile::~ZipFile() = default;

core::Result<void> ZipFile::add(const std::string& name, const std::string& content) {
  if (parts_->begin(name, content.size()) && parts_->write(content)) return {};
  return failure();
}

core::Result<void> ZipFile::add(const std::string& name, const std::filesystem::path& content) {
  std::ifstream in(content, std::ios::binary);
  std::error_code missing;
  bool added = parts_->begin(name, std::filesystem::file_size(content, missing)) && !missing;
  for (std::string piece(kZipPiece_bytes, 0); added && in;) {
    in.read(piece.data(), kZipPiece_bytes);
    added = parts_->write(std::string_view(piece).substr(0, static_cast<std::size_t>(in.gcount())));
  }
  if (added) return {};
  return failure();
}

core::Result<void> ZipFile::finish() {
  if (archive_write_close(parts_->writer.get()) != ARCHIVE_OK) return failure();
  parts_->out.file.close();
  if (parts_->out.file) return {};
  return failure();
}

core::Error ZipFile::failure() const {
  if (parts_->out.size <= parts_->out.most_bytes)
    return {core::Errc::io, "the zip cannot be written: the disk is possibly full"};
  return {core::Errc::too_large,
          fmt::format("the zip is larger than {} MiB", parts_->out.most_bytes >> 20)};
}

}  // namespace lab_io
}  // namespace tractus
