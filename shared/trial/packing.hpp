/// Blocks of samples, made small without losing a bit: what PACK frames hold.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "trial/trial.hpp"

namespace tractus::trial {

/// Column by column: the bits of a number as an integer, their second difference (of a rendered
/// force and torque: the difference to the model's), the sign in the lowest bit, the bytes of equal
/// weight side by side, then zstd. Smooth motion leaves the noise of the last bits alone. Any bits
/// come back as they were, those that no sample may hold too. A block's differences begin with the
/// last two samples before it: packing and unpacking must be told (`follow`) of every block that
/// stands. One trial, one thread at a time.
class Packer {
 public:
  Packer();
  ~Packer();
  Packer(Packer&&) noexcept;
  Packer& operator=(Packer&&) noexcept;

  /// Payload of a PACK frame: u32 count, then what zstd made of the planes. 1 to
  /// max_packed_samples() of them. Valid until the next call.
  core::ByteView pack(std::span<const Sample> samples);
  core::ByteView pack(std::span<const ProbingSample> samples);

  /// The next block comes after these samples: they were written, or read.
  void follow(std::span<const Sample> samples);
  void follow(std::span<const ProbingSample> samples);

  /// The samples of a payload, at most max_packed_samples(); nothing is reserved that the count
  /// alone claims. Errors: corrupt, with what is wrong.
  core::Result<void> unpack(core::ByteView payload, std::vector<Sample>& out);
  core::Result<void> unpack(core::ByteView payload, std::vector<ProbingSample>& out);

 private:
  struct State;
  template <class S>
  core::ByteView pack_of(std::span<const S> samples);
  template <class S>
  core::Result<void> unpack_of(core::ByteView payload, std::vector<S>& out);
  std::unique_ptr<State> state_;
};

/// Samples that fit one PACK frame whatever they hold, by the size of one.
std::size_t max_packed_samples(std::size_t sample_bytes);

}  // namespace tractus::trial
