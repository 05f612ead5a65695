#include "fuzz/trial_bytes.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "core/require.hpp"
#include "trial/frames.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace fuzz {
namespace {
using core::require;

void require_one_line(const core::Error& error) {
  require(!error.what.empty() && error.what.size() < 1000, "a message is one bearable line");
  require(error.what.find('\n') == std::string::npos, "a message is one line");
}

template <class S>
bool same(const std::vector<S>& a, const std::vector<S>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

bool same(const trial::Trial& a, const trial::Trial& b) {
  return same(a.samples, b.samples) && same(a.probing, b.probing);
}

template <class S>
void require_sound(const std::vector<S>& samples, std::size_t file_bytes) {
  const std::size_t frames = file_bytes / (trial::kFrameHeader_bytes + sizeof(std::uint32_t));
  require(samples.size() <= frames * trial::max_frame_samples(sizeof(S)),
          "a frame holds no more samples than it may");
  const S* before = nullptr;
  for (const auto& sample : samples) {
    require(trial::fault_of(sample, before).empty(), "every sample that is handed out is sound");
    before = &sample;
  }
}

void require_sound(const trial::Trial& read, std::size_t file_bytes) {
  require_sound(read.samples, file_bytes);
  require_sound(read.probing, file_bytes);
  require(read.samples.empty() || read.probing.empty(), "a trial holds samples of one rig");
  require(read.sealed || !read.complete, "only a sealed trial is complete");
}

void require_recoverable(const std::string& path, const trial::Trial& read) {
  const auto kept = trial::recover_trial(path);
  require(bool(kept), "what can be read can be recovered");
  const auto again = trial::read_trial(path);
  require(bool(again) && again->sealed, "a recovered trial is sealed");
  require(*kept == read.block().size() && same(*again, read),
          "recovery keeps exactly the samples that could be read");
}
}  // namespace

core::Bytes repaired(core::Bytes bytes) {
  const auto magic = core::bytes_of(trial::kMagic);
  if (bytes.size() < magic.size()) return bytes;
  const bool one = core::text_of(bytes).starts_with(trial::kMagicOne);
  std::ranges::copy(one ? core::bytes_of(trial::kMagicOne) : magic, bytes.begin());
  std::size_t at = magic.size();
  std::uint64_t samples = 0;
  for (std::uint32_t sequence = 0; at + trial::kFrameHeader_bytes <= bytes.size(); ++sequence) {
    std::uint32_t type = 0, length = 0;
    std::memcpy(&type, &bytes[at], 4);
    std::memcpy(&length, &bytes[at + 4], 4);
    const std::size_t room = bytes.size() - at - trial::kFrameHeader_bytes;
    length = std::uint32_t(std::min<std::size_t>(length, room));
    std::byte* payload = bytes.data() + at + trial::kFrameHeader_bytes;
    if (trial::FrameType(type) == trial::FrameType::end && length == trial::kEndPayload_bytes)
      std::ranges::copy(trial::end_payload(samples, core::sha256(core::ByteView(bytes).first(at))),
                        payload);
    std::uint32_t count = 0;  // of a frame of samples: what it says of itself
    const bool holds_samples = trial::FrameType(type) == trial::FrameType::samples ||
                               trial::FrameType(type) == trial::FrameType::packed;
    if (holds_samples && length >= sizeof count) std::memcpy(&count, payload, sizeof count);
    samples += count;
    const auto frame =
        trial::frame_bytes(trial::FrameType(type), sequence,
                           {payload, std::min<std::size_t>(length, trial::kMaxPayload_bytes)});
    std::copy_n(frame.begin(), trial::kFrameHeader_bytes, bytes.begin() + std::ptrdiff_t(at));
    at += trial::kFrameHeader_bytes + length;
  }
  return bytes;
}

bool try_trial(core::ByteView bytes) {
  const int fd = ::memfd_create("trial", MFD_CLOEXEC);
  require(fd >= 0, "there is memory for a file");
  require(trial::write_all(fd, bytes), "there is memory for a file");
  const std::string path = "/proc/self/fd/" + std::to_string(fd);
  const auto read = trial::read_trial(path);
  trial::Trial seen;
  const auto scanned = trial::scan_trial(path, [&seen](const trial::Block& block) {
    seen.samples.insert(seen.samples.end(), block.palpation.begin(), block.palpation.end());
    seen.probing.insert(seen.probing.end(), block.probing.begin(), block.probing.end());
  });
  require(bool(read) == bool(scanned), "reading and scanning agree");
  if (read) {
    require(same(seen, *read), "reading and scanning agree");
    require_sound(*read, bytes.size());
    require_recoverable(path, *read);
  } else {
    require_one_line(read.error());
    if (const auto kept = trial::recover_trial(path); !kept) require_one_line(kept.error());
  }
  ::close(fd);
  return bool(read);
}

}  // namespace fuzz
}  // namespace tractus
