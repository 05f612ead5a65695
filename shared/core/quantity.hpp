/// Scalars with their dimension: mass^M · length^L · time^T, always SI inside. Mixing dimensions
/// does not compile.
#pragma once

#include <compare>

namespace tractus {
namespace core {

template <int M, int L, int T>
struct Quantity {
  double si = 0.0;  ///< the value in SI units

  friend constexpr auto operator<=>(Quantity, Quantity) = default;
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return {a.si + b.si}; }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return {a.si - b.si}; }
  friend constexpr Quantity operator-(Quantity a) { return {-a.si}; }
  friend constexpr Quantity operator*(double k, Quantity a) { return {k * a.si}; }
  friend constexpr Quantity operator*(Quantity a, double k) { return {k * a.si}; }
  friend constexpr Quantity operator/(Quantity a, double k) { return {a.si / k}; }
};

template <int M, int L, int T, int M2, int L2, int T2>
constexpr Quantity<M + M2, L + L2, T + T2> operator*(Quantity<M, L, T> a, Quantity<M2, L2, T2> b) {
  return {a.si * b.si};
}
template <int M, int L, int T, int M2, int L2, int T2>
constexpr Quantity<M - M2, L - L2, T - T2> operator/(Quantity<M, L, T> a, Quantity<M2, L2, T2> b) {
  return {a.si / b.si};
}

using Number = Quantity<0, 0, 0>;
using Length = Quantity<0, 1, 0>;      ///< m
using Duration = Quantity<0, 0, 1>;    ///< s
using Mass = Quantity<1, 0, 0>;        ///< kg
using Speed = Quantity<0, 1, -1>;      ///< m/s
using Force = Quantity<1, 1, -2>;      ///< N
using Torque = Quantity<1, 2, -2>;     ///< N·m
using Pressure = Quantity<1, -1, -2>;  ///< Pa
using Stiffness = Quantity<1, 0, -2>;  ///< N/m
using Damping = Quantity<1, 0, -1>;    ///< N·s/m
using Frequency = Quantity<0, 0, -1>;  ///< Hz

namespace literals {
constexpr Length operator""_m(long double v) { return {double(v)}; }
constexpr Length operator""_mm(long double v) { return {double(v) * 1e-3}; }
constexpr Duration operator""_s(long double v) { return {double(v)}; }
constexpr Duration operator""_ms(long double v) { return {double(v) * 1e-3}; }
constexpr Mass operator""_kg(long double v) { return {double(v)}; }
constexpr Speed operator""_m_s(long double v) { return {double(v)}; }
constexpr Force operator""_N(long double v) { return {double(v)}; }
constexpr Torque operator""_Nm(long double v) { return {double(v)}; }
constexpr Pressure operator""_Pa(long double v) { return {double(v)}; }
constexpr Pressure operator""_GPa(long double v) { return {double(v) * 1e9}; }
constexpr Stiffness operator""_N_per_m(long double v) { return {double(v)}; }
constexpr Damping operator""_Ns_per_m(long double v) { return {double(v)}; }
constexpr Frequency operator""_Hz(long double v) { return {double(v)}; }
}  // namespace literals

}  // namespace core
}  // namespace tractus
