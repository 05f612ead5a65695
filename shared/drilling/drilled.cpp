#include "drilling/drilled.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <cmath>
#include <cstring>

#include "core/file.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace drilling {
namespace {

using core::Errc;
using core::Error;
using core::Json;

constexpr std::string_view kMagic = "tractus-drilled/1\n";
constexpr std::uint32_t kMostHeader = 64 << 10;
constexpr std::uint64_t kMostBytes = 256ull << 20;  // of a file

std::size_t voxels_of(const volume::Box& box) {
  std::size_t n = 1;
  for (std::size_t a = 0; a < 3; ++a) n *= std::size_t(std::max(box.end[a] - box.begin[a], 0));
  return n;
}

/// Calls `take(first count in the volume, first count in the box, how many)` for each row.
template <class Take>
void each_row(const volume::Box& box, const std::array<int, 3>& dims, Take&& take) {
  const auto width = std::size_t(std::max(box.end[0] - box.begin[0], 0));
  std::size_t in_box = 0;
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j, in_box += width) {
      const auto row = std::size_t(k) * std::size_t(dims[1]) + std::size_t(j);
      take(row * std::size_t(dims[0]) + std::size_t(box.begin[0]), in_box, width);
    }
}

core::Bytes packed(const std::vector<std::uint16_t>& counts) {
  const std::size_t bytes = counts.size() * sizeof(std::uint16_t);
  core::Bytes out(ZSTD_compressBound(bytes));
  const std::size_t size = ZSTD_compress(out.data(), out.size(), counts.data(), bytes, 3);
  core::require(!ZSTD_isError(size), "a block always fits the bound zstd gave for it");
  out.resize(size);
  return out;
}

std::array<int, 3> ints(core::Fields& fields, const char* key, const std::array<int, 3>& most) {
  std::array<int, 3> out{};
  const auto numbers = fields.numbers(key, 3);
  for (std::size_t a = 0; a < numbers.size() && a < 3; ++a) {
    if (!(numbers[a] >= 0 && numbers[a] <= most[a] && numbers[a] == std::floor(numbers[a])))
      return fields.wrong(key, "three whole numbers within the volume are expected"), out;
    out[a] = int(numbers[a]);
  }
  return out;
}

/// The header's fields into `out`; the hash it names into `sha256`.
core::Result<void> read_header(const Json& json, const std::string& where,
                               const std::string& trial_id, const std::string& case_id,
                               const std::array<int, 3>& dims, Drilled& out, std::string& sha256) {
  core::Fields fields(json, where);
  if (fields.text("trial_id") != trial_id) fields.wrong("trial_id", trial_id + " is expected");
  if (fields.text("case_id") != case_id)
    fields.wrong("case_id", "the case that was drilled, " + case_id + ", is expected");
  out.dims = ints(fields, "dims", dims);
  if (out.dims != dims) fields.wrong("dims", "those of the case's volume are expected");
  out.removed_m3 = fields.number("removed_m3", 0.0, 1.0);
  out.changes = std::uint32_t(fields.integer("changes", 0, 0xffffffffl));
  sha256 = fields.text("counts_sha256");
  if (const Json* found = fields.member("box"); found && found->is_object()) {
    core::Fields box(*found, where + "/box");
    out.box.begin = ints(box, "begin", dims);
    out.box.end = ints(box, "end", dims);
    TRY(box.done());
  }
  return fields.done();
}

Error about(const std::filesystem::path& path, Errc code, const std::string& what) {
  return {code, path.string() + ": " + what};
}

}  // namespace

std::string Drilled::sha256() const {
  core::Sha256 hash;
  hash.add(core::bytes_of(fmt::format("{} {}-{}\n", fmt::join(dims, " "), fmt::join(box.begin, " "),
                                      fmt::join(box.end, " "))));
  hash.add(std::as_bytes(std::span(counts)));
  return hash.hex();
}

Json Drilled::to_json() const {
  return {{"dims", dims},
          {"box", {{"begin", box.begin}, {"end", box.end}}},
          {"removed_m3", removed_m3},
          {"changes", changes},
          {"counts_sha256", sha256()}};
}

void Drilled::put_into(volume::Volume& volume) const {
  core::require(volume.geometry.dims == dims, "a drilled state is put into the volume it is of");
  each_row(box, dims, [&](std::size_t to, std::size_t from, std::size_t n) {
    std::copy_n(counts.begin() + std::ptrdiff_t(from), n,
                volume.counts.begin() + std::ptrdiff_t(to));
  });
}

Drilled drilled_of(const Erosion& erosion) {
  const volume::Volume& now = erosion.volume();
  Drilled out{.dims = now.geometry.dims,
              .box = erosion.box(),
              .removed_m3 = erosion.removed_m3(),
              .changes = erosion.changes(),
              .counts = {}};
  out.counts.resize(voxels_of(out.box));
  each_row(out.box, out.dims, [&](std::size_t from, std::size_t to, std::size_t n) {
    std::copy_n(now.counts.begin() + std::ptrdiff_t(from), n,
                out.counts.begin() + std::ptrdiff_t(to));
  });
  return out;
}

core::Result<void> write_drilled(const std::filesystem::path& path, const Drilled& drilled,
                                 const std::string& trial_id, const std::string& case_id) {
  Json header = {{"trial_id", trial_id}, {"case_id", case_id}};
  header.update(drilled.to_json());
  const std::string text = header.dump();
  const auto length = std::uint32_t(text.size());
  core::Bytes out(core::bytes_of(kMagic).begin(), core::bytes_of(kMagic).end());
  const auto add = [&out](core::ByteView part) { out.insert(out.end(), part.begin(), part.end()); };
  add(std::as_bytes(std::span(&length, 1)));
  add(core::bytes_of(text));
  add(packed(drilled.counts));
  return core::write_file(path, out);
}

core::Result<Drilled> read_drilled(const std::filesystem::path& path, const std::string& trial_id,
                                   const std::string& case_id, const std::array<int, 3>& dims) {
  const auto bytes = TRY(core::read_file(path, kMostBytes));
  std::uint32_t length = 0;
  constexpr std::size_t kFront = kMagic.size() + sizeof(length);
  if (!core::text_of(bytes).starts_with(kMagic) || bytes.size() < kFront)
    return about(path, Errc::bad_input, "is no tractus-drilled/1 file");
  std::memcpy(&length, bytes.data() + kMagic.size(), sizeof(length));
  if (length > kMostHeader || length > bytes.size() - kFront)
    return about(path, Errc::corrupt,
                 fmt::format("a header of {} bytes in a file of {}", length, bytes.size()));
  const auto json = TRY(
      core::parse_json(core::text_of(bytes).substr(kFront, length), path.string() + ": header"));
  Drilled out;
  std::string sha256;
  TRY(read_header(json, path.string(), trial_id, case_id, dims, out, sha256));
  const auto rest = core::ByteView(bytes).subspan(kFront + length);
  const std::size_t want = voxels_of(out.box) * sizeof(std::uint16_t);
  if (ZSTD_getFrameContentSize(rest.data(), rest.size()) != want)
    return about(path, Errc::corrupt, fmt::format("does not hold the {} bytes of its box", want));
  out.counts.resize(voxels_of(out.box));
  if (ZSTD_decompress(out.counts.data(), want, rest.data(), rest.size()) != want ||
      out.sha256() != sha256)
    return about(path, Errc::corrupt, "the counts are not those that the header names");
  return out;
}

}  // namespace drilling
}  // namespace tractus
