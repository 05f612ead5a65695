/// One instance of an exported model, as an importer drives it: what FMI's functions do.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "fmu/module/simulation.hpp"

namespace tractus::fmu {

/// An instance knows no other: several run at once, each in one thread at a time. A call that is refused changes
/// nothing.
///
/// At a communication point the outputs follow from the inputs as they stand, and change with them at
/// once; `step` takes these inputs as the motion at that point, whatever remembers moves on to it, and time goes
/// on. So the outputs are those of a replay whose samples are the communication points. During the
/// step an input goes on with its derivative, 0 if none was set.
class Instance {
 public:
  using References = std::span<const unsigned int>;

  /// Parameters and errors are those of read_carried.
  static core::Result<std::unique_ptr<Instance>> make(std::string_view guid,
                                                      std::string_view resources);

  /// @param stop_s  nothing if the importer does not know it
  core::Result<void> set_up(double start_s, std::optional<double> stop_s);
  core::Result<void> begin_initialization();
  core::Result<void> end_initialization();
  core::Result<void> set(References references, const double* values);
  /// First derivatives by time.
  core::Result<void> set_derivatives(References references, const int* orders,
                                     const double* values);
  core::Result<void> get(References references, double* values);
  core::Result<void> step(double t_s, double length_s);
  core::Result<void> terminate();
  void reset() { state_ = beginning(); }
  double time_s() const noexcept { return state_.t_s; }

  /// All that changes.
  struct State;
  std::unique_ptr<State> state() const;
  void restore(const State& state);

 private:
  enum class Phase { instantiated, initializing, stepping, terminated };

 public:
  struct State {
    Phase phase = Phase::instantiated;
    std::vector<double> values;       ///< by value reference
    std::vector<double> derivatives;  ///< of the inputs
    double start_s = 0.0, t_s = 0.0;
    std::optional<double> stop_s = {};
    std::unique_ptr<Simulation> simulation = {};  ///< once the parameters are known
  };

 private:
  explicit Instance(std::unique_ptr<Carried> carried);
  State beginning() const;
  static State copy_of(const State& state);
  core::Result<void> expect(bool holds, const char* call) const;
  core::Result<void> check(unsigned int reference, double value) const;
  core::Result<void> prepare();
  core::Result<std::vector<double>> outputs();

  std::unique_ptr<Carried> carried_;
  std::span<const Variable> variables_;
  Order order_;
  State state_;
};

}  // namespace tractus::fmu
