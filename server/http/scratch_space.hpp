/// Room on the disk for large bodies and answers under way, shared among those who ask.
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

/// Bytes under way at the same time.
struct ScratchLimits {
  std::uint64_t per_client = 1536ull << 20;  ///< the largest body that a route takes, and more
  std::uint64_t in_all = 6ull << 30;
};

/// A folder and how much of it is in use. Safe from several threads.
class ScratchSpace {
 public:
  explicit ScratchSpace(std::filesystem::path folder, ScratchLimits limits = {})
      : folder_(std::move(folder)), limits_(limits) {}
  ScratchSpace(const ScratchSpace&) = delete;
  ScratchSpace& operator=(const ScratchSpace&) = delete;

  /// Bytes that are reserved until this goes; not beyond the space that it is of.
  class Share {
   public:
    Share() = default;
    Share(ScratchSpace& space, std::string client, std::uint64_t bytes)
        : space_(&space), client_(std::move(client)), bytes_(bytes) {}
    ~Share();
    Share(Share&& other) noexcept;
    Share& operator=(Share&& other) noexcept;
    /// Gives back what is over `bytes`, once it is known that no more are needed.
    void shrink_to(std::uint64_t bytes);

   private:
    ScratchSpace* space_ = nullptr;
    std::string client_;
    std::uint64_t bytes_ = 0;
  };

  /// @param client  account, station or whoever else asks; all of one share its limit
  /// Errors: unavailable when the client, or all together, would have more than the limit.
  core::Result<Share> reserve(const std::string& client, std::uint64_t bytes);
  const std::filesystem::path& folder() const { return folder_; }
  /// A name in the folder that nothing has.
  std::filesystem::path new_name() const;

 private:
  void give_back(const std::string& client, std::uint64_t bytes);

  const std::filesystem::path folder_;
  const ScratchLimits limits_;
  std::mutex mutex_;  ///< guards what follows
  std::map<std::string, std::uint64_t> by_client_;
  std::uint64_t all_ = 0;
};

/// A file in the scratch folder, deleted with this.
struct ScratchFile {
  std::filesystem::path path;
  ScratchSpace::Share share;

  ScratchFile(std::filesystem::path at, ScratchSpace::Share of)
      : path(std::move(at)), share(std::move(of)) {}
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
};

/// A name for a file of at most so many bytes, which whoever asks for it makes. Errors:
/// unavailable.
core::Result<std::shared_ptr<ScratchFile>> scratch_file(ScratchSpace& space,
                                                        const std::string& client,
                                                        std::uint64_t bytes);

}  // namespace tractus::http
