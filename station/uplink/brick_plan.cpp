#include "station/uplink/brick_plan.hpp"

#include <algorithm>
#include <fstream>

#include "cases/case.hpp"
#include "core/json.hpp"
#include "volume/brick.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kMagic = "TRACTVOL";
constexpr std::uint32_t kVersion = 1, kMaxHeader_bytes = 1u << 20;
constexpr std::uint64_t kEntry_bytes = 4 + 32, kMaxBricks = 1u << 16;
constexpr int kMaxSide = 4096;

std::uint32_t u32_at(core::ByteView bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (int i = 3; i >= 0; --i)
    out = out << 8 | std::to_integer<std::uint32_t>(bytes[at + std::size_t(i)]);
  return out;
}

std::optional<std::uint64_t> brick_count(core::ByteView header) {
  const auto json = core::parse_json(core::text_of(header), "volume header");
  if (!json || !json->is_object() || !json->contains("dims")) return std::nullopt;
  const core::Json& dims = (*json)["dims"];
  if (!dims.is_array() || dims.size() != 3) return std::nullopt;
  std::array<int, 3> sides{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!dims[i].is_number_integer()) return std::nullopt;
    sides[i] = dims[i].get<int>();
    if (sides[i] < 1 || sides[i] > kMaxSide) return std::nullopt;
  }
  std::uint64_t out = 1;
  for (const int bricks : volume::brick_grid(sides)) out *= static_cast<std::uint64_t>(bricks);
  return out <= kMaxBricks ? std::optional(out) : std::nullopt;
}

core::Bytes first_bytes(const fs::path& path, std::uint64_t size) {
  core::Bytes out(size);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  out.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return out;
}

std::optional<BrickIndex> index_of_file(const fs::path& path) {
  std::uint64_t known = kVolumeHead_bytes;
  while (true) {
    const core::Bytes head = first_bytes(path, known);
    const auto end = index_end(head);
    if (!end || head.size() < known) return std::nullopt;
    if (*end <= known) return brick_index(head);
    known = *end;
  }
}

}  // namespace

std::optional<std::uint64_t> index_end(core::ByteView head) {
  if (head.size() < kVolumeHead_bytes || core::text_of(head.first(kMagic.size())) != kMagic ||
      u32_at(head, 8) != kVersion)
    return std::nullopt;
  const std::uint32_t header = u32_at(head, 12);
  if (header > kMaxHeader_bytes) return std::nullopt;
  const std::uint64_t body = kVolumeHead_bytes + header;
  if (head.size() < body) return body;
  const auto bricks = brick_count(head.subspan(kVolumeHead_bytes, header));
  return bricks ? std::optional(body + *bricks * kEntry_bytes) : std::nullopt;
}

std::optional<BrickIndex> brick_index(core::ByteView head) {
  const auto end = index_end(head);
  if (!end || *end > head.size()) return std::nullopt;
  std::uint64_t at = kVolumeHead_bytes + u32_at(head, 12);
  BrickIndex out;
  out.end = *end;
  for (; at < *end; at += kEntry_bytes) {
    const std::uint32_t size = u32_at(head, at);
    out.bricks.push_back({std::string(core::text_of(head.subspan(at + 4, 32))), out.end, size});
    out.end += size;
  }
  return out;
}

LocalParts::LocalParts(const fs::path& cases_folder) {
  std::error_code failure;
  for (const auto& folder : fs::directory_iterator(cases_folder, failure)) {
    const auto json = core::read_json(folder.path() / "case.json");
    if (!json) continue;
    const auto definition = cases::Case::from_json(*json, "case.json: ");
    if (!definition) continue;
    for (const cases::Part& part : definition->parts) {
      const fs::path file = folder.path() / part.name;
      std::error_code ignored;
      if (part.secret || fs::file_size(file, ignored) != part.size_bytes) continue;
      parts_.emplace(part.sha256, file);
      const auto index = index_of_file(file);
      if (!index || index->end != part.size_bytes) continue;
      for (const auto& brick : index->bricks)
        bricks_.emplace(brick.digest, Place{file, brick.offset, brick.size});
    }
  }
}

std::optional<fs::path> LocalParts::whole(const std::string& sha256) const {
  const auto found = parts_.find(sha256);
  return found == parts_.end() ? std::nullopt : std::optional(found->second);
}

std::vector<Segment> LocalParts::plan(core::ByteView head, std::uint64_t size) const {
  const auto index = brick_index(head);
  if (!index || index->end != size) return {{.offset = 0, .size = size}};
  std::vector<Segment> out{
      {.offset = 0, .size = index->bricks.empty() ? size : index->bricks.front().offset}};
  for (const auto& brick : index->bricks) {
    const auto found = bricks_.find(brick.digest);
    const bool here = found != bricks_.end() && found->second.size == brick.size;
    if (!here && out.back().from.empty())
      out.back().size += brick.size;
    else if (!here)
      out.push_back({.offset = brick.offset, .size = brick.size});
    else
      out.push_back({brick.offset, brick.size, found->second.file, found->second.offset});
  }
  return out;
}

}  // namespace uplink
}  // namespace tractus
