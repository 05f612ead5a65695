/// The frames of a trial file: how bytes become frames and frames bytes. The format is in
/// shared/doc/trial-format.md; users of trials want trial_file.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::trial {

/// First bytes of every file that is written.
inline constexpr std::string_view kMagic = "tractus-trial/2\n";
/// Of files that are read for ever: samples as they are, no packed ones.
inline constexpr std::string_view kMagicOne = "tractus-trial/1\n";

/// Four ASCII letters, as they stand in the file.
enum class FrameType : std::uint32_t {
  header = 0x44414548,   ///< "HEAD": JSON, exactly one, the first
  samples = 0x504D4153,  ///< "SAMP": u32 count, then count × 136 bytes (probing: 64)
  packed = 0x4B434150,   ///< "PACK": u32 count, then as packing.hpp has it; not in /1
  event = 0x544E5645,    ///< "EVNT": JSON
  end = 0x4C414553,  ///< "SEAL": u64 sample count, SHA-256 of all bytes before the frame; exactly
                     ///< one, the last
};

inline constexpr std::size_t kFrameHeader_bytes = 20;
inline constexpr std::size_t kMaxPayload_bytes = 1u << 20;
inline constexpr std::size_t kMaxJson_bytes = 256u << 10;  ///< of one header or event
inline constexpr std::size_t kMaxEvents_bytes = 8u << 20;  ///< of all events of a file together
inline constexpr std::size_t kEndPayload_bytes = 8 + 32;
/// Samples that fit one frame, by the size of one.
constexpr std::size_t max_frame_samples(std::size_t sample_bytes) {
  return (kMaxPayload_bytes - 4) / sample_bytes;
}

/// A frame with its header: type, length, sequence, CRC-32C of the payload, CRC-32C of those
/// sixteen bytes; payload.
core::Bytes frame_bytes(FrameType type, std::uint32_t sequence, core::ByteView payload);
/// Payload of the end frame. `sha256_hex` is of all bytes of the file before the frame.
core::Bytes end_payload(std::uint64_t samples, const std::string& sha256_hex);
/// Payload of a JSON frame: no spaces; text that is not UTF-8 is replaced.
core::Bytes json_payload(const core::Json& json);

/// One line for a person, "FILE: offset N: WHAT", stripped of control characters and cut to a
/// bearable length.
core::Error frame_error(core::Errc code, const std::filesystem::path& path, std::uint64_t offset,
                        const std::string& what);

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  int fd() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

/// One write() where the system takes it whole, as regular files do; goes on after a short one.
bool write_all(int fd, core::ByteView bytes);

/// Reads a file frame by frame, in the memory of one frame.
class FrameReader {
 public:
  /// Errors: not_found, io, bad_input (not a regular file), too_large (over `max_bytes`), corrupt
  /// (not our magic).
  static core::Result<FrameReader> open(const std::filesystem::path& path, std::uint64_t max_bytes);

  enum class Step {
    frame,    ///< a whole frame was read
    end,      ///< the file ends here, on a frame's edge
    torn,     ///< the rest is a frame that was not written to its end, or nothing but zeros
    damaged,  ///< the last frame has all its bytes, and its payload's checksum does not hold
  };
  /// Errors: corrupt, with the offset, for what no interrupted writer leaves; io.
  core::Result<Step> next();

  FrameType type() const { return type_; }
  core::ByteView payload() const { return payload_; }
  std::uint64_t offset() const { return offset_; }  ///< of the frame (or the torn rest) last met
  std::uint64_t position() const { return position_; }  ///< just behind the frames read
  std::uint64_t size() const { return size_; }          ///< of the file, when it was opened
  std::uint32_t next_sequence() const { return sequence_; }
  /// The hash of all bytes before the end frame, or read so far: takes it away, ask once.
  core::Sha256 take_hash() { return std::move(hash_); }
  const std::filesystem::path& path() const { return path_; }

 private:
  FrameReader(std::filesystem::path path, Descriptor file, std::uint64_t size);
  core::Result<void> read(std::byte* into, std::size_t count);
  core::Result<void> fill();
  core::Result<Step> rest_of_zeros();
  core::Error corrupt(const std::string& what) const;

  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t size_ = 0, position_ = 0, offset_ = 0;
  std::uint32_t sequence_ = 0;
  bool may_pack_ = true;
  FrameType type_{};
  core::Bytes read_ahead_;  ///< bytes of the file that are not taken yet, from taken_ on
  std::size_t taken_ = 0;
  core::Bytes payload_;
  core::Sha256 hash_;
};

}  // namespace tractus::trial
