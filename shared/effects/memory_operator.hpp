/// What a formula may remember: operators with a state, advanced once a moment along a motion.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace tractus::effects {

/// With u, f, v, x parts of the formula:
///
///     lag(u, τ)             dz/dt = (u − z)/τ, z = u at the start                          as u
///     play(u, gap)          z stays while |u − z| <= gap/2 and is drawn along else         as u
///     dahl(u, δ)            dz = du − |du| z/δ, z = 0 at the start            [Olsson1998] as u
///     bouc_wen(u, δ, g)     dz = du − (|du| z + g du |z|)/δ                     [Noel2016] as u
///     work(f, x)            ∫ max(f dx, 0), work done against f                            f·x
///     since_reversal(x)     way along x since it last turned back                          as x
///     since_stop(v)         time since v was last rest, 0 while it is                      s
///     age(x, D)             dz/dt = 1 − |dx/dt| z/D, age of a contact    [Dieterich1979]   s
///     resonator(x, f, ζ)    d²y/dt² of a mass that x draws by a spring and a damper:
///                           d²y/dt² = (2πf)² (x − y) + 4πζf d(x − y)/dt       [DenHartog1956] x/s²
///
/// Each is advanced exactly for signals that are straight between two moments (but for the force of
/// work's first step), so that neither the rate of a recording nor a station's tick changes it.
enum class MemoryOperator : std::uint8_t {
  lag,
  play,
  dahl,
  bouc_wen,
  work,
  since_reversal,
  since_stop,
  age,
  resonator,
};

/// How a result's unit follows from the arguments'.
enum class MemoryUnit : std::uint8_t { as_first, product, second, per_second_squared };
/// What an argument must be.
enum class MemoryArgument : std::uint8_t { any, as_first, plain, second, hertz, length, speed };

struct MemoryOperatorInfo {
  MemoryOperator id;
  std::string_view name, arguments;
  std::size_t count;  ///< of arguments
  std::array<MemoryArgument, 3> takes;
  MemoryUnit gives;
  bool zero_of_zero;  ///< stays 0 where its first argument always is
};
std::span<const MemoryOperatorInfo> memory_operators();
/// Null for a name that is none.
const MemoryOperatorInfo* find_memory_operator(std::string_view name);

/// What has to be known of a moment.
struct MemoryStep {
  double dt_s = 0.0;      ///< since the moment before
  double rest_m_s = 0.0;  ///< a slower motion is rest, see direction()
};

inline constexpr std::size_t kMostMemories = 6;    ///< operators in one formula
inline constexpr std::size_t kStatesOfMemory = 4;  ///< numbers that one keeps

/// What one formula's operators keep from moment to moment.
struct FormulaMemory {
  bool started = false;
  std::array<double, kMostMemories * kStatesOfMemory> states{};
};

using MemoryArguments = std::array<double, 3>;
using MemoryStates = std::span<double, kStatesOfMemory>;
/// The value of the first moment; sets the states.
double begin(MemoryOperator which, const MemoryArguments& arguments, MemoryStates states) noexcept;
/// The value of the next moment; moves the states on to it. Allocates nothing and never fails; the
/// result may not be finite where a parameter is out of its sense.
double advance(MemoryOperator which, const MemoryArguments& arguments, const MemoryStep& step,
               MemoryStates states) noexcept;

}  // namespace tractus::effects
