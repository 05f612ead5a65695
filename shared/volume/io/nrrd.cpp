#include <fmt/format.h>
#include <teem/biff.h>
#include <teem/nrrd.h>

#include <fstream>
#include <memory>

#include "core/try.hpp"
#include "volume/io/claims.hpp"
#include "volume/io/counts.hpp"
#include "volume/io/formats.hpp"
#include "volume/io/nrrd_header.hpp"

namespace tractus {
namespace volume_io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kHeaderLimit = 1u << 16;

struct FreeNrrd {
  void operator()(Nrrd* nrrd) const { nrrdNuke(nrrd); }
};

/// teem's own words about its last failure, one line.
std::string teem_error() {
  char* text = biffGetDone(NRRD);
  std::string out = text ? text : "";
  std::free(text);
  if (const auto end = out.find('\n'); end != std::string::npos) out.resize(end);
  return printable(out);
}

core::Result<std::string> header_text(const fs::path& path) {
  TRY(size_of_file(path));
  std::ifstream file(path, std::ios::binary);
  std::string text(kHeaderLimit, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

core::Result<void> check_size(const NrrdHeader& header, const core::Progress& progress) {
  const std::uint64_t expected =
      header.geometry.voxel_count() * static_cast<std::uint64_t>(header.sample_bytes);
  if (header.gzip) {
    if (!is_gzip(header.data, header.data_at))
      return bad(header.data, fmt::format("encoding is gzip, but no gzip stream begins at byte {}",
                                          header.data_at));
    return check_gzip(header.data, header.data_at, expected, progress);
  }
  const auto size = TRY(size_of_file(header.data));
  if (size != header.data_at + expected)
    return bad(header.data, fmt::format("has {} bytes, its header declares {}", size,
                                        header.data_at + expected));
  return {};
}

template <class T>
core::Result<Counts> counts_as(const Nrrd& nrrd, std::size_t voxels) {
  return counts_of(std::span(static_cast<const T*>(nrrd.data), voxels), 1.0, 0.0);
}

core::Result<Counts> counts_of_nrrd(const Nrrd& nrrd, std::size_t voxels) {
  switch (nrrd.type) {
    case nrrdTypeChar:
      return counts_as<signed char>(nrrd, voxels);
    case nrrdTypeUChar:
      return counts_as<unsigned char>(nrrd, voxels);
    case nrrdTypeShort:
      return counts_as<std::int16_t>(nrrd, voxels);
    case nrrdTypeUShort:
      return counts_as<std::uint16_t>(nrrd, voxels);
    case nrrdTypeInt:
      return counts_as<std::int32_t>(nrrd, voxels);
    case nrrdTypeUInt:
      return counts_as<std::uint32_t>(nrrd, voxels);
    case nrrdTypeFloat:
      return counts_as<float>(nrrd, voxels);
    case nrrdTypeDouble:
      return counts_as<double>(nrrd, voxels);
    default:
      return core::Error{core::Errc::bad_input, "its kind of number is not known"};
  }
}

}  // namespace

core::Result<Imported> read_nrrd(const fs::path& path, const core::Progress& progress) {
  const auto text = TRY(header_text(path));
  auto header = TRY(parse_nrrd(text, path));
  TRY(check_size(header, progress));
  const std::unique_ptr<Nrrd, FreeNrrd> nrrd(nrrdNew());
  nrrdStateVerboseIO = 0;
  if (nrrdLoad(nrrd.get(), path.c_str(), nullptr) != 0)
    return bad(path, fmt::format("cannot be read: {}", teem_error()));
  const std::size_t voxels = header.geometry.voxel_count();
  if (nrrdElementNumber(nrrd.get()) != voxels ||
      nrrdElementSize(nrrd.get()) != static_cast<std::size_t>(header.sample_bytes))
    return bad(path, "cannot be read: header and voxels disagree");
  auto counts = counts_of_nrrd(*nrrd, voxels);
  if (!counts) return bad(path, counts.error().what);
  Imported out{{header.geometry, counts->slope, counts->intercept, std::move(counts->counts)},
               "NRRD",
               path.filename().string(),
               std::move(header.notes)};
  if (!counts->note.empty()) out.notes.push_back(counts->note);
  return out;
}

}  // namespace volume_io
}  // namespace tractus
