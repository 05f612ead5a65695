/// Whole files, safely: a reader sees the old file or the new one, never half of one.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::core {

/// Reads all of a regular file. Errors: not_found, io, too_large (over `limit_bytes`, checked
/// before reading).
Result<Bytes> read_file(const std::filesystem::path& path, std::uint64_t limit_bytes = 1ull << 30);

/// Whether a new file may take this name: nothing is there, or a regular file (or a link to one).
/// Errors: conflict on a folder, a device or a pipe, which a rename would put out of the way.
Result<void> may_be_replaced(const std::filesystem::path& path);

/// That, and whether its folder is there and lets a file be made: to be asked before long work.
/// Errors: conflict, io.
Result<void> may_be_written(const std::filesystem::path& path);

/// Writes beside, flushes to the disk, renames, flushes the folder. Nothing is left behind on
/// failure. Errors: io, those of `may_be_replaced`.
Result<void> write_file(const std::filesystem::path& path, ByteView bytes);

/// The errno of the last call as an Error: "PATH: cannot open: Permission denied".
Error system_error(const std::filesystem::path& path, const char* what);

/// fsync of a folder, so that a rename in it lasts.
Result<void> sync_folder(const std::filesystem::path& folder);

/// Leaves a folder and all in it to their owner alone (0700, 0600, or 0700 for a program), and
/// returns how many files and folders others had access to. Links are not followed. A folder called
/// `trusted` that was private already is not entered: it may hold millions of files. Errors: io, as
/// when a file is another user's.
Result<std::size_t> make_private(const std::filesystem::path& folder,
                                 std::string_view trusted = "");

/// A new empty folder of mode 0700 beside `beside`, removed with all in it when this goes, unless
/// `keep_as` renamed it. For results of several files: build inside, then keep.
class ScratchFolder {
 public:
  static Result<ScratchFolder> make(const std::filesystem::path& beside);
  ~ScratchFolder();
  ScratchFolder(ScratchFolder&&) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  const std::filesystem::path& path() const { return path_; }
  /// Gives it the mode that a new folder has, and moves it to `target`; an existing `target` of
  /// that name is an Error conflict.
  Result<void> keep_as(const std::filesystem::path& target);

 private:
  ScratchFolder(std::filesystem::path path, std::filesystem::perms kept)
      : path_(std::move(path)), kept_(kept) {}
  std::filesystem::path path_;
  std::filesystem::perms kept_;  ///< once it is kept: the umask's
};

}  // namespace tractus::core
