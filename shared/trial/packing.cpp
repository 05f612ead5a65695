#include "trial/packing.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <array>
#include <cstring>

#include "trial/frames.hpp"

namespace tractus {
namespace trial {
namespace {

constexpr int kZstdLevel = -1;  // 1 gains 1 % on frames of 20 ms and takes half as long again
constexpr std::size_t kMargin_bytes = 8 << 10;  // what zstd may add to a MiB it cannot make smaller
constexpr std::uint16_t kNone = 0xffff;

/// The last two samples before a block, the newer one last; zeros where there are none.
using Before = std::array<std::array<std::byte, sizeof(Sample)>, 2>;

/// One number of a sample: where its bytes are, and of which other number's bits it is a small
/// correction, if of one.
struct Column {
  std::uint16_t offset, bytes;
  std::uint16_t after = kNone;
};

template <class S>
struct Columns;
template <>
struct Columns<Sample> {
  static constexpr std::array<Column, 27> kAll{
      {{0, 8},      {8, 8},      {16, 8},     {24, 8},      {32, 8},      {40, 8},      {48, 8},
       {56, 8},     {64, 4},     {68, 4},     {72, 4},      {76, 4},      {80, 4},      {84, 4},
       {88, 4, 64}, {92, 4, 68}, {96, 4, 72}, {100, 4, 76}, {104, 4, 80}, {108, 4, 84}, {112, 4},
       {116, 4},    {120, 4},    {124, 2},    {126, 2},     {128, 4},     {132, 4}}};
};
template <>
struct Columns<ProbingSample> {
  static constexpr std::array<Column, 14> kAll{{{0, 8},
                                                {8, 8},
                                                {16, 8},
                                                {24, 4},
                                                {28, 4},
                                                {32, 4},
                                                {36, 4},
                                                {40, 4},
                                                {44, 4},
                                                {48, 4, 40},
                                                {52, 4},
                                                {56, 4},
                                                {60, 2},
                                                {62, 2}}};
};

/// Every byte of a sample is in exactly one column, in order: so nothing is lost.
template <class S>
constexpr bool whole() {
  std::size_t at = 0;
  for (const Column& column : Columns<S>::kAll) {
    if (column.offset != at || (column.after != kNone && column.after >= column.offset))
      return false;
    at += column.bytes;
  }
  return at == sizeof(S);
}
static_assert(whole<Sample>() && whole<ProbingSample>());

/// The bits of one column as words of T, with room for two before them.
template <class T>
class Bits {
 public:
  explicit Bits(std::vector<std::uint64_t>& room, std::size_t count) : count_(count) {
    room.resize(count + 2);
    bits_ = reinterpret_cast<T*>(room.data());
  }
  T* values() { return bits_ + 2; }

  /// The two values before, from the two samples before.
  void begin_with(const Before& before, std::size_t offset) {
    std::memcpy(&bits_[0], before[0].data() + offset, sizeof(T));
    std::memcpy(&bits_[1], before[1].data() + offset, sizeof(T));
  }

  void gather(const std::byte* samples, std::size_t stride, std::size_t offset) {
    for (std::size_t i = 0; i < count_; ++i)
      std::memcpy(&bits_[i + 2], samples + i * stride + offset, sizeof(T));
  }

 private:
  T* bits_;
  std::size_t count_;
};

/// A small negative number in few bytes: the sign goes to the lowest bit.
template <class T>
T folded(T value) {
  const auto sign = static_cast<T>(T{0} - static_cast<T>(value >> (8 * sizeof(T) - 1)));
  return static_cast<T>(static_cast<T>(value << 1) ^ sign);
}
template <class T>
T unfolded(T value) {
  return static_cast<T>(static_cast<T>(value >> 1) ^
                        static_cast<T>(T{0} - static_cast<T>(value & 1)));
}

/// Room that is used again from block to block.
struct Rooms {
  std::vector<std::uint64_t> values, others, rests;
};

template <class T>
void pack_column(const std::byte* samples, std::size_t count, std::size_t stride,
                 const Column& column, const Before& before, Rooms& rooms, std::byte* planes) {
  Bits<T> bits(rooms.values, count), rest(rooms.rests, count);
  bits.gather(samples, stride, column.offset);
  const T* x = bits.values();
  T* r = rest.values();
  if (column.after != kNone) {
    Bits<T> other(rooms.others, count);
    other.gather(samples, stride, column.after);
    const T* o = other.values();
    for (std::size_t i = 0; i < count; ++i) r[i] = folded(static_cast<T>(x[i] - o[i]));
  } else {
    bits.begin_with(before, column.offset);
    const T *one = x - 1, *two = x - 2;
    for (std::size_t i = 0; i < count; ++i)
      r[i] = folded(static_cast<T>(x[i] - 2 * one[i] + two[i]));
  }
  for (std::size_t byte = 0; byte < sizeof(T); ++byte, planes += count)
    for (std::size_t i = 0; i < count; ++i) planes[i] = static_cast<std::byte>(r[i] >> (8 * byte));
}

/// One number from its bytes, which are `count` apart.
template <class T>
T word_of(const std::byte* planes, std::size_t count) {
  T out = 0;
  for (std::size_t byte = 0; byte < sizeof(T); ++byte)
    out = static_cast<T>(out | static_cast<T>(static_cast<T>(planes[byte * count]) << (8 * byte)));
  return out;
}

template <class T>
T load(const std::byte* from) {
  T out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

template <class T>
void unpack_column(const std::byte* planes, std::size_t count, std::size_t stride,
                   const Column& column, const Before& before, std::byte* samples) {
  std::byte* x = samples + column.offset;
  if (column.after != kNone) {
    const std::byte* other = samples + column.after;
    for (std::size_t i = 0; i < count; ++i, x += stride, other += stride) {
      const T value = static_cast<T>(unfolded(word_of<T>(planes + i, count)) + load<T>(other));
      std::memcpy(x, &value, sizeof value);
    }
    return;
  }
  T last = load<T>(before[1].data() + column.offset);
  T step = static_cast<T>(last - load<T>(before[0].data() + column.offset));
  for (std::size_t i = 0; i < count; ++i, x += stride) {
    step = static_cast<T>(step + unfolded(word_of<T>(planes + i, count)));
    last = static_cast<T>(last + step);
    std::memcpy(x, &last, sizeof last);
  }
}

/// `work` with the column's word as its type.
template <class Work>
void by_width(const Column& column, Work&& work) {
  switch (column.bytes) {
    case 8:
      return work(std::uint64_t{});
    case 4:
      return work(std::uint32_t{});
    default:
      return work(std::uint16_t{});
  }
}

core::Error corrupt(std::string what) { return {core::Errc::corrupt, std::move(what)}; }

struct FreeContexts {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

struct Packer::State {
  std::unique_ptr<ZSTD_CCtx, FreeContexts> packing{ZSTD_createCCtx()};
  std::unique_ptr<ZSTD_DCtx, FreeContexts> unpacking{ZSTD_createDCtx()};
  Rooms rooms;
  core::Bytes planes, payload;
  Before before{};

  template <class S>
  void follow(std::span<const S> samples) {
    for (const S& sample : samples.last(std::min<std::size_t>(samples.size(), 2))) {
      before[0] = before[1];
      std::memcpy(before[1].data(), &sample, sizeof sample);
    }
  }
};

Packer::Packer() : state_(std::make_unique<State>()) {
  core::require(state_->packing && state_->unpacking, "there is memory for zstd");
}
Packer::~Packer() = default;
Packer::Packer(Packer&&) noexcept = default;
Packer& Packer::operator=(Packer&&) noexcept = default;

std::size_t max_packed_samples(std::size_t sample_bytes) {
  return (kMaxPayload_bytes - sizeof(std::uint32_t) - kMargin_bytes) / sample_bytes;
}

template <class S>
core::ByteView Packer::pack_of(std::span<const S> samples) {
  core::require(!samples.empty() && samples.size() <= max_packed_samples(sizeof(S)),
                "a packed block holds 1 to max_packed_samples");
  State& s = *state_;
  const auto count = static_cast<std::uint32_t>(samples.size());
  const auto* bytes = reinterpret_cast<const std::byte*>(samples.data());
  s.planes.resize(samples.size_bytes());
  std::byte* at = s.planes.data();
  for (const Column& column : Columns<S>::kAll) {
    by_width(column, [&](auto word) {
      pack_column<decltype(word)>(bytes, count, sizeof(S), column, s.before, s.rooms, at);
    });
    at += column.bytes * count;
  }
  s.payload.resize(sizeof count + ZSTD_compressBound(s.planes.size()));
  std::memcpy(s.payload.data(), &count, sizeof count);
  const std::size_t size = ZSTD_compressCCtx(s.packing.get(), s.payload.data() + sizeof count,
                                             s.payload.size() - sizeof count, s.planes.data(),
                                             s.planes.size(), kZstdLevel);
  core::require(!ZSTD_isError(size), "a block always fits the bound zstd gave for it");
  return core::ByteView(s.payload).first(sizeof count + size);
}

template <class S>
core::Result<void> Packer::unpack_of(core::ByteView payload, std::vector<S>& out) {
  State& s = *state_;
  std::uint32_t count = 0;
  if (payload.size() >= sizeof count) std::memcpy(&count, payload.data(), sizeof count);
  if (count == 0 || count > max_packed_samples(sizeof(S)))
    return corrupt(fmt::format("{} packed samples said, 1 to {} may be", count,
                               max_packed_samples(sizeof(S))));
  s.planes.resize(count * sizeof(S));
  const auto packed = payload.subspan(sizeof count);
  const std::size_t size = ZSTD_decompressDCtx(s.unpacking.get(), s.planes.data(), s.planes.size(),
                                               packed.data(), packed.size());
  if (ZSTD_isError(size) || size != s.planes.size())
    return corrupt(fmt::format(
        "{} packed samples said, {}", count,
        ZSTD_isError(size) ? ZSTD_getErrorName(size) : fmt::format("{} bytes unpacked", size)));
  out.resize(count);
  auto* bytes = reinterpret_cast<std::byte*>(out.data());
  const std::byte* at = s.planes.data();
  for (const Column& column : Columns<S>::kAll) {
    by_width(column, [&](auto word) {
      unpack_column<decltype(word)>(at, count, sizeof(S), column, s.before, bytes);
    });
    at += column.bytes * count;
  }
  return {};
}

void Packer::follow(std::span<const Sample> samples) { state_->follow(samples); }
void Packer::follow(std::span<const ProbingSample> samples) { state_->follow(samples); }
core::ByteView Packer::pack(std::span<const Sample> samples) { return pack_of(samples); }
core::ByteView Packer::pack(std::span<const ProbingSample> samples) { return pack_of(samples); }
core::Result<void> Packer::unpack(core::ByteView payload, std::vector<Sample>& out) {
  return unpack_of(payload, out);
}
core::Result<void> Packer::unpack(core::ByteView payload, std::vector<ProbingSample>& out) {
  return unpack_of(payload, out);
}

}  // namespace trial
}  // namespace tractus
