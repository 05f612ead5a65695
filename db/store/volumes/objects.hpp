/// Files of the data folder: objects named by their content, and the partial files of uploads.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "db/store/volumes/object_store.hpp"

namespace tractus::store {

/// DATA/objects/ab/cdef…: a file exists completely or not at all, never changes, and its name is
/// its SHA-256. Objects are kept there; or in an object store beyond the folder, whose cache the
/// folder is then: each object is put in both, and fetched when a file of it is asked for.
class Objects {
 public:
  /// @param data    the data folder; `objects` in it is made when it is not there.
  /// @param beyond  where objects are kept; nothing: in the folder.
  static core::Result<Objects> open(const std::filesystem::path& data,
                                    std::unique_ptr<ObjectStore> beyond = nullptr);
  ~Objects();
  Objects(Objects&&) noexcept;
  Objects& operator=(Objects&&) noexcept;

  /// Where an object lies in the folder, if it is there. @pre is_sha256(sha256)
  std::filesystem::path path_of(const std::string& sha256) const;
  /// A file with the object, in the folder; fetched and checked if need be. It stays for an hour at
  /// least. Errors: not_found, io, unavailable, corrupt; without a store beyond none: opening tells.
  core::Result<std::filesystem::path> file(const std::string& sha256) const;
  /// Bytes of an object where objects are kept; nothing if it is not there. Errors: unavailable.
  core::Result<std::optional<std::uint64_t>> size_of(const std::string& sha256) const;
  /// SHA-256 of the bytes as they are read where objects are kept.
  core::Result<std::string> kept_sha256(const std::string& sha256) const;

  core::Result<std::string> put(core::ByteView bytes) const;
  /// Copies a file to the objects, with bounded memory, and checks its SHA-256. Errors: corrupt if
  /// the SHA-256 differs.
  core::Result<void> copy_in(const std::filesystem::path& file, const std::string& sha256) const;
  /// Copies an object to where these objects are kept, and nowhere else.
  core::Result<void> copy_from(const Objects& source, const std::string& sha256) const;
  /// Gives a finished file, whose content was checked, a second name among the objects. The first
  /// name stays.
  core::Result<void> link_in(const std::filesystem::path& file, const std::string& sha256) const;
  /// One that is not there is removed already.
  core::Result<void> remove(const std::string& sha256) const;

  /// From now on, files of a folder that is a cache go when they are over this size together: those
  /// first whose last use is longest ago, none that was used within the last hour.
  void limit_cache(std::uint64_t most_bytes);

 private:
  struct Beyond;
  Objects(std::filesystem::path root, std::unique_ptr<Beyond> beyond);
  bool here(const std::string& sha256) const;
  core::Result<void> folder_for(const std::string& sha256) const;
  core::Result<void> put_beyond(const std::string& sha256) const;
  std::filesystem::path root_;
  std::unique_ptr<Beyond> beyond_;  ///< none: objects are kept in the folder
};

/// DATA/uploads/TRIAL.part: grows by acknowledged chunks.
class PartialFiles {
 public:
  static core::Result<PartialFiles> open(const std::filesystem::path& data);

  /// @pre is_id(trial_id)
  std::filesystem::path path_of(const std::string& trial_id) const;
  /// How much of an upload is here; 0 when there is no file. What it counts was flushed, unless a
  /// process died within `append` (`flush` then).
  std::uint64_t size_of(const std::string& trial_id) const;
  /// Writes at the end, which is at `offset`, and returns once the disk has it (fdatasync; for a
  /// new file its folder too). Errors: io; the file is then as long as before.
  core::Result<void> append(const std::string& trial_id, std::uint64_t offset,
                            core::ByteView bytes) const;
  core::Result<void> flush(const std::string& trial_id) const;
  void remove(const std::string& trial_id) const noexcept;
  /// Trials that have one.
  std::vector<std::string> ids() const;
  const std::filesystem::path& folder() const { return root_; }

 private:
  explicit PartialFiles(std::filesystem::path root) : root_(std::move(root)) {}
  std::filesystem::path root_;
};

/// Reads a file from its start in pieces of at most 1 MiB; `size` bytes of it.
/// Errors: those of the system; corrupt when it is shorter.
core::Result<std::string> file_sha256(const std::filesystem::path& path);

}  // namespace tractus::store
