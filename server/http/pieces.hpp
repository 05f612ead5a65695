/// A file on its way to a socket, piece by piece, read by workers. For server.cpp alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tractus::http {

inline constexpr std::size_t kPiece_bytes = 256 * 1024;  ///< read at once
inline constexpr std::size_t kSent_bytes = 4u << 20;  ///< sent at once, when the kernel takes them

/// A descriptor that closes itself.
class File {
 public:
  explicit File(const std::filesystem::path& path);
  /// Another name of a socket, so that it stays the same one whoever closes it meanwhile.
  static File again(int socket);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  explicit operator bool() const { return fd_ >= 0; }
  /// Fills all of `piece`; false when the file is shorter or cannot be read.
  bool read_at(std::uint64_t offset, std::string& piece) const;
  /// Copies to a socket that does not block, within the kernel: how many bytes it took; nothing
  /// when the file is shorter or the other side is gone.
  std::optional<std::uint64_t> send_to(const File& socket, std::uint64_t offset,
                                       std::uint64_t size) const;

 private:
  explicit File(int fd) : fd_(fd) {}
  int fd_;
};

struct ReadingPiece {
  const File* file;
  std::string* piece;
  std::uint64_t offset;
  bool operator()() const { return file->read_at(offset, *piece); }
};
struct SendingPiece {
  const File *file, *socket;
  std::uint64_t offset, size;
  std::optional<std::uint64_t> operator()() const { return file->send_to(*socket, offset, size); }
};

}  // namespace tractus::http
