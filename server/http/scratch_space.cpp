#include "server/http/scratch_space.hpp"

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus::http {

ScratchSpace::Share::~Share() {
  if (space_) space_->give_back(client_, bytes_);
}

ScratchSpace::Share::Share(Share&& other) noexcept
    : space_(std::exchange(other.space_, nullptr)),
      client_(std::move(other.client_)),
      bytes_(other.bytes_) {}

ScratchSpace::Share& ScratchSpace::Share::operator=(Share&& other) noexcept {
  std::swap(space_, other.space_);
  std::swap(client_, other.client_);
  std::swap(bytes_, other.bytes_);
  return *this;
}

void ScratchSpace::Share::shrink_to(std::uint64_t bytes) {
  if (!space_ || bytes >= bytes_) return;
  space_->give_back(client_, bytes_ - bytes);
  bytes_ = bytes;
}

core::Result<ScratchSpace::Share> ScratchSpace::reserve(const std::string& client,
                                                        std::uint64_t bytes) {
  const auto refusal = [&](const char* whose, std::uint64_t limit, std::uint64_t taken) {
    return core::Error{
        core::Errc::unavailable,
        fmt::format("{} transfers in progress use {} bytes; with the {} bytes of this transfer "
                    "they would exceed {} bytes: try again when they are finished",
                    whose, taken, bytes, limit)};
  };
  const std::lock_guard held(mutex_);
  const auto at = by_client_.find(client);
  const std::uint64_t own = at == by_client_.end() ? 0 : at->second;
  if (bytes > limits_.per_client || own > limits_.per_client - bytes)
    return refusal("your", limits_.per_client, own);
  if (bytes > limits_.in_all || all_ > limits_.in_all - bytes)
    return refusal("all", limits_.in_all, all_);
  by_client_[client] += bytes;
  all_ += bytes;
  return Share(*this, client, bytes);
}

void ScratchSpace::give_back(const std::string& client, std::uint64_t bytes) {
  const std::lock_guard held(mutex_);
  all_ -= bytes;
  const auto at = by_client_.find(client);
  if (at == by_client_.end()) return;  // of a share of no bytes
  at->second -= bytes;
  if (at->second == 0) by_client_.erase(at);
}

std::filesystem::path ScratchSpace::new_name() const {
  return folder_ / ("body-" + core::hex(core::random_bytes(8)) + ".spool");
}

ScratchFile::~ScratchFile() {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

core::Result<std::shared_ptr<ScratchFile>> scratch_file(ScratchSpace& space,
                                                        const std::string& client,
                                                        std::uint64_t bytes) {
  auto share = TRY(space.reserve(client, bytes));
  return std::make_shared<ScratchFile>(space.new_name(), std::move(share));
}

}  // namespace tractus::http
