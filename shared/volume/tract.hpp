/// The channel of a pedicle screw, and what is medial, lateral, superior, inferior and anterior of
/// it.
#pragma once

#include <array>

#include "core/named.hpp"
#include "math/geometry.hpp"

namespace tractus::volume {

using math::Vec3;

enum class Wall { medial, lateral, superior, inferior, anterior };
constexpr auto words(Wall) {
  using enum Wall;
  return std::to_array<core::Word<Wall>>({{medial, "medial"},
                                          {lateral, "lateral"},
                                          {superior, "superior"},
                                          {inferior, "inferior"},
                                          {anterior, "anterior"}});
}
using core::name;
inline constexpr auto kWalls = core::values<Wall>();

/// A straight channel from its entry along `axis`. The side walls' directions are unit vectors in
/// V, perpendicular to the axis; medial = −lateral, inferior = −superior, and the two pairs are
/// perpendicular. Anterior is the end: the axis.
struct Tract {
  Vec3 entry_m = Vec3::Zero();  ///< centre of the mouth, in V
  Vec3 axis = Vec3::UnitZ();    ///< unit vector into the bone, in V
  double length_m = 0.0;
  double radius_m = 0.0;
  Vec3 medial = Vec3::UnitX();    ///< unit vector, perpendicular to axis
  Vec3 superior = Vec3::UnitY();  ///< unit vector, perpendicular to axis and to medial

  Vec3 end_m() const { return entry_m + length_m * axis; }
  /// Depth along the axis (0 at the mouth), m.
  double depth_of(const Vec3& p_V_m) const { return (p_V_m - entry_m).dot(axis); }
  /// Offset from the axis: (towards medial, towards superior), m.
  math::Vec2 offset_of(const Vec3& p_V_m) const {
    const Vec3 d = p_V_m - entry_m;
    return {d.dot(medial), d.dot(superior)};
  }
  /// The side wall nearest to a direction (towards medial, towards superior).
  static Wall side_of(const math::Vec2& offset) {
    if (std::abs(offset.x()) >= std::abs(offset.y()))
      return offset.x() >= 0 ? Wall::medial : Wall::lateral;
    return offset.y() >= 0 ? Wall::superior : Wall::inferior;
  }
};

}  // namespace tractus::volume
