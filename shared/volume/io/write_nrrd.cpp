#include "volume/io/write_nrrd.hpp"

#include <fmt/format.h>
#include <teem/biff.h>
#include <teem/nrrd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "volume/io/claims.hpp"

namespace tractus {
namespace volume_io {
namespace {

struct FreeHeader {  // the voxels belong to a vector
  void operator()(Nrrd* nrrd) const { nrrdNix(nrrd); }
};
struct FreeState {
  void operator()(NrrdIoState* state) const { nrrdIoStateNix(state); }
};

/// Whether each CT value is a whole number that 16 bits hold.
bool is_short(const volume::Volume& v) {
  if (v.slope != 1.0 || v.intercept != std::round(v.intercept)) return false;
  const auto [low, high] = std::minmax_element(v.counts.begin(), v.counts.end());
  if (low == v.counts.end()) return true;
  using Limits = std::numeric_limits<std::int16_t>;
  return v.intercept + *low >= Limits::min() && v.intercept + *high <= Limits::max();
}

template <class T>
std::vector<T> values_of(const volume::Volume& v) {
  std::vector<T> out(v.counts.size());
  std::ranges::transform(v.counts, out.begin(), [&v](std::uint16_t count) {
    return static_cast<T>(v.intercept + v.slope * count);
  });
  return out;
}

/// LPS and millimetres.
void set_geometry(Nrrd& nrrd, const volume::Geometry& geometry) {
  nrrdSpaceSet(&nrrd, nrrdSpaceLeftPosteriorSuperior);
  for (int a = 0; a < 3; ++a) {
    const auto axis = std::size_t(a);
    nrrd.axis[axis].kind = nrrdKindDomain;
    nrrd.spaceOrigin[axis] = geometry.origin_m[a] * 1e3;
    nrrd.spaceUnits[axis] = airStrdup("mm");
    for (int b = 0; b < 3; ++b)
      nrrd.axis[axis].spaceDirection[std::size_t(b)] =
          geometry.directions(b, a) * geometry.spacing_m[a] * 1e3;
  }
}

core::Error failed(const std::filesystem::path& path) {
  char* text = biffGetDone(NRRD);
  const std::string said = text ? text : "";
  std::free(text);
  return {core::Errc::io, fmt::format("{}: cannot be written: {}", path.string(), printable(said))};
}

template <class T>
core::Result<void> write_as(int type, const std::filesystem::path& path,
                            const volume::Volume& volume) {
  auto values = values_of<T>(volume);
  const std::unique_ptr<Nrrd, FreeHeader> nrrd(nrrdNew());
  const auto& dims = volume.geometry.dims;
  const std::size_t size[3] = {std::size_t(dims[0]), std::size_t(dims[1]), std::size_t(dims[2])};
  if (nrrdWrap_nva(nrrd.get(), values.data(), type, 3, size) != 0) return failed(path);
  set_geometry(*nrrd, volume.geometry);
  const std::unique_ptr<NrrdIoState, FreeState> state(nrrdIoStateNew());
  nrrdIoStateEncodingSet(state.get(), nrrdEncodingGzip);
  nrrdStateVerboseIO = 0;
  if (nrrdSave(path.c_str(), nrrd.get(), state.get()) != 0) return failed(path);
  return {};
}

}  // namespace

core::Result<void> write_nrrd(const std::filesystem::path& path, const volume::Volume& volume) {
  return is_short(volume) ? write_as<std::int16_t>(nrrdTypeShort, path, volume)
                          : write_as<float>(nrrdTypeFloat, path, volume);
}

}  // namespace volume_io
}  // namespace tractus
