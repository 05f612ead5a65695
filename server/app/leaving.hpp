/// People who left: the server's part of their erasure beside the records, and the list by which a restored backup loses them again.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "db/store/people/erasure.hpp"
#include "server/app/data_folder.hpp"

namespace tractus::app {

/// In the data folder, and beside the backups that people make on the web pages: numbers and opaque ids, no names.
inline constexpr const char* kErasureList = "erasures.list";

/// Errors: io, bad_input naming the file and the field.
core::Result<std::vector<store::Erasure>> read_erasure_list(const std::filesystem::path& file);
/// Writes all erasures of the records to a file, whole or not at all.
core::Result<void> write_erasure_list(store::Store& store, const std::filesystem::path& file);

/// Writes the lists, then finishes every erasure that was begun. What was interrupted is finished by the next call.
core::Result<void> finish_erasures(DataFolder& data,
                                   const std::vector<std::filesystem::path>& lists);

/// Erases in a restored folder everybody of the list who is in it, wholly. Returns how many.
core::Result<std::size_t> apply_erasures(DataFolder& data, const std::vector<store::Erasure>& list);

/// A thread that finishes erasures and keeps the retention rules while the server serves: at its start, when it is woken, and every
/// ten minutes.
class Leaving {
 public:
  /// @param forget  called after every erasure, by whichever process, and once at the start: drops what is held of people in memory
  Leaving(DataFolder& data, std::vector<std::filesystem::path> lists, std::function<void()> forget);
  ~Leaving();
  Leaving(const Leaving&) = delete;
  Leaving& operator=(const Leaving&) = delete;
  void wake();

 private:
  void run();
  core::Result<void> pass();
  void forget_if_somebody_left();

  DataFolder& data_;
  const std::vector<std::filesystem::path> lists_;
  const std::function<void()> forget_;
  std::optional<std::size_t> erasures_;  ///< when it was called last
  std::mutex mutex_;                     ///< guards what follows
  bool woken_ = true;
  bool ending_ = false;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace tractus::app
