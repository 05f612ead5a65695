/// Where objects are kept when the data folder is not their place for good.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::store {

/// Objects named by their SHA-256, at a place that outlasts this machine. What `put` and `remove`
/// have acknowledged is durable there. Called by several threads at once.
/// Errors of all: unavailable (no answer, or a refusal that the message names; trying later may help).
class ObjectStore {
 public:
  /// Takes a piece; false ends the transfer.
  using Take = std::function<bool(core::ByteView)>;

  virtual ~ObjectStore() = default;
  /// Copies a file there. One that is there already stays. Errors: also corrupt (the SHA-256
  /// differs), those of reading the file.
  virtual core::Result<void> put(const std::string& sha256,
                                 const std::filesystem::path& file) const = 0;
  /// Hands out `size` bytes from `offset` on, or up to the end; whoever takes them checks them.
  /// Errors: also not_found, cancelled (`take` ended it).
  virtual core::Result<void> read(const std::string& sha256, std::uint64_t offset,
                                  std::optional<std::uint64_t> size, const Take& take) const = 0;
  /// Bytes; nothing if it is not there.
  virtual core::Result<std::optional<std::uint64_t>> size_of(const std::string& sha256) const = 0;
  /// One that is not there is removed already.
  virtual core::Result<void> remove(const std::string& sha256) const = 0;
};

}  // namespace tractus::store
