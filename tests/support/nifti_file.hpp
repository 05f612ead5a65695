/// A small NIfTI-1 file, byte by byte as nifti1.h lays it out, to be changed by whoever tests its
/// reader.
#pragma once

#include <array>
#include <cstring>

#include "core/bytes.hpp"
#include "volume/volume.hpp"

namespace tractus::test_support {

inline constexpr std::array kNiftiDims{5, 4, 3};

/// A NIfTI-1 file in memory, byte by byte as nifti1.h lays it out; millimetres, int16, value = 100
/// k + 10 j + i − 50.
struct NiftiFile {
  core::Bytes bytes = core::Bytes(352);
  template <class T>
  void set(std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof(T));
  }
  NiftiFile() {
    set<std::int32_t>(0, 348);
    set<std::int16_t>(40, 3);
    for (std::size_t a = 0; a < 3; ++a)
      set<std::int16_t>(42 + 2 * a, static_cast<std::int16_t>(kNiftiDims[a]));
    set<std::int16_t>(70, 4);
    set<std::int16_t>(72, 16);
    for (std::size_t a = 0; a < 4; ++a) set<float>(76 + 4 * a, 1.0f);
    set<float>(108, 352.0f);
    set<char>(123, 2);
    std::memcpy(bytes.data() + 344, "n+1", 4);
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 5; ++i) {
          const auto value = static_cast<std::int16_t>(100 * k + 10 * j + i - 50);
          bytes.insert(bytes.end(), {static_cast<std::byte>(value & 0xff),
                                     static_cast<std::byte>(value >> 8 & 0xff)});
        }
  }
  void sform(const volume::Mat3& steps_mm, const volume::Vec3& origin_mm, std::int16_t code = 1) {
    set<std::int16_t>(254, code);
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c)
        set<float>(280 + 16 * r + 4 * c, static_cast<float>(steps_mm(int(r), int(c))));
      set<float>(292 + 16 * r, static_cast<float>(origin_mm[int(r)]));
    }
  }
  void qform(const Eigen::Quaterniond& q, double qfac, const volume::Vec3& spacing_mm,
             const volume::Vec3& origin_mm) {
    set<std::int16_t>(252, 1);
    const double sign = q.w() < 0 ? -1 : 1;
    for (std::size_t a = 0; a < 3; ++a) {
      set<float>(256 + 4 * a, static_cast<float>(sign * q.vec()[int(a)]));
      set<float>(268 + 4 * a, static_cast<float>(origin_mm[int(a)]));
      set<float>(80 + 4 * a, static_cast<float>(spacing_mm[int(a)]));
    }
    set<float>(76, static_cast<float>(qfac));
  }
};

inline NiftiFile plain_nifti() {
  NiftiFile file;
  file.sform(volume::Mat3::Identity(), volume::Vec3::Zero());
  return file;
}

}  // namespace tractus::test_support
