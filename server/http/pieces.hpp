/// Sends a file to a socket piece by piece; worker threads read the file. Only server.cpp uses it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace tractus::http {

inline constexpr std::size_t kPiece_bytes = 256 * 1024;  ///< read at once
inline constexpr std::size_t kSent_bytes = 4u << 20;     ///< sent in one go, to who reads fast

/// Has the other side of the socket closed it, or at least its sending half?
bool is_closed_by_peer(int socket);

/// Owns a file descriptor and closes it.
class File {
 public:
  explicit File(const std::filesystem::path& path);
  /// A duplicate of a socket's descriptor, which stays valid if the original descriptor is closed.
  static File again(int socket);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  explicit operator bool() const { return fd_ >= 0; }
  /// Fills `piece` completely; false if the file is too short or cannot be read.
  bool read_at(std::uint64_t offset, std::string& piece) const;
  /// Copies to a non-blocking socket, and waits up to 2 ms while it empties. Returns the number of
  /// bytes that the socket accepted, 0 if it was full; nothing if the file is too short or the
  /// connection is closed.
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
