/// Disk space for large bodies and answers in transfer, shared among the clients.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "core/result.hpp"

namespace tractus::http {

/// Largest numbers of bytes in transfer at the same time.
struct ScratchLimits {
  std::uint64_t per_client = 1536ull << 20;  ///< more than the largest body that a route allows
  std::uint64_t in_all = 6ull << 30;
};

/// A folder and the number of its bytes in use. Thread-safe.
class ScratchSpace {
 public:
  explicit ScratchSpace(std::filesystem::path folder, ScratchLimits limits = {})
      : folder_(std::move(folder)), limits_(limits) {}
  ScratchSpace(const ScratchSpace&) = delete;
  ScratchSpace& operator=(const ScratchSpace&) = delete;

  /// A reservation of bytes until this object is destroyed; the space must outlive it.
  class Share {
   public:
    Share() = default;
    Share(ScratchSpace& space, std::string client, std::uint64_t bytes)
        : space_(&space), client_(std::move(client)), bytes_(bytes) {}
    ~Share();
    Share(Share&& other) noexcept;
    Share& operator=(Share&& other) noexcept;
    /// Reduces the reservation to `bytes`, once it is known that no more are needed.
    void shrink_to(std::uint64_t bytes);

   private:
    ScratchSpace* space_ = nullptr;
    std::string client_;
    std::uint64_t bytes_ = 0;
  };

  /// @param client  id of the account or station; all transfers of one client share its limit
  /// Errors: unavailable if the client, or all clients together, would exceed the limit.
  core::Result<Share> reserve(const std::string& client, std::uint64_t bytes);
  const std::filesystem::path& folder() const { return folder_; }
  /// An unused file name in the folder.
  std::filesystem::path new_name() const;

 private:
  void give_back(const std::string& client, std::uint64_t bytes);

  const std::filesystem::path folder_;
  const ScratchLimits limits_;
  std::mutex mutex_;  ///< guards what follows
  std::map<std::string, std::uint64_t> by_client_;
  std::uint64_t all_ = 0;
};

/// A file in the scratch folder; the destructor deletes it.
struct ScratchFile {
  std::filesystem::path path;
  ScratchSpace::Share share;

  ScratchFile(std::filesystem::path at, ScratchSpace::Share of)
      : path(std::move(at)), share(std::move(of)) {}
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
};

/// Reserves space for a file of at most `bytes`, and a name for it; the caller creates the file.
/// Errors: unavailable.
core::Result<std::shared_ptr<ScratchFile>> scratch_file(ScratchSpace& space,
                                                        const std::string& client,
                                                        std::uint64_t bytes);

}  // namespace tractus::http
