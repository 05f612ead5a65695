/// A burr at work: the bone is worn by a thread beside the loop, and felt from the next tick on.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "core/clock.hpp"
#include "drilling/drilled.hpp"
#include "drilling/redrill.hpp"
#include "models/palpation_runtime.hpp"
#include "station/loop/haptic_loop.hpp"
#include "station/loop/ring.hpp"
#include "station/loop/tool.hpp"

namespace tractus::loop {

/// Owns the bone as it is drilled, its field, and the model on it.
///
///     loop's thread      worked: sample ─────► ring ─┐           ┌─► apply: rows copied
///     this one's thread                   Erosion ─► FieldPatch ─┘
///
/// The field is written by the loop's thread alone, one patch a tick (drilling::kMostPatchFloats
/// bounds it), between two samplings: nobody sees half a change. Between the threads are wait-free
/// rings and patches made beforehand. A worker that lags delays what is taken away and loses
/// nothing; at kRoom samples behind, `fell_behind` says that the trial must end.
class Drilling final : public Tool {
 public:
  static constexpr std::size_t kRoom = 16384;  ///< samples: four seconds

  /// The model with the burr's shank. `bone` must outlive this. Errors: those of drilling::Erosion,
  /// ForceField and the model.
  static core::Result<std::unique_ptr<Drilling>> make(const volume::Volume& bone,
                                                      models::PalpationModel model,
                                                      const drilling::Burr& burr,
                                                      const core::Progress& progress = {});
  ~Drilling() override;

  /// The model on the living field, for the loop's contact.
  const models::PalpationRuntime& runtime() const noexcept { return *runtime_; }
  const drilling::Setup& setup() const noexcept { return setup_; }

  std::uint32_t apply(double t_s) noexcept override;
  void worked(const trial::Sample& sample) noexcept override;
  bool fell_behind() const noexcept { return behind_.load(std::memory_order_relaxed); }

  /// A thread of its own from now on; `clock` paces its looking and must outlive it.
  void start(core::Clock& clock);
  /// Without a thread: works off what waits, on the loop's own (a loop under a manual clock).
  void work();
  /// After the loop: works off the rest. The result holds from here on.
  void finish();
  const drilling::Erosion& erosion() const noexcept { return erosion_; }
  /// From a sample to the tick that felt what it took away, s; a tenth of a millisecond fine.
  double lag_quantile_s(double share) const noexcept { return lag_.quantile_us(share) * 1e-4; }

  /// From any one thread that shows the bone: writes into `shown` (the bone, or what this wrote
  /// before) what changed since the last call; the box of it, nothing when nothing did or the
  /// worker is at it just now (then the next call has it). Never waits.
  std::optional<volume::Box> show(volume::Volume& shown);
  /// Likewise: what was worn until now; nothing when the burr was not at work since the last call,
  /// or the worker is at it just now. Never waits.
  std::optional<drilling::ErodedShares> worn();

 private:
  struct Slot {
    volume::FieldPatch patch{drilling::kMostPatchFloats};
    double t_s = 0.0;
  };
  Drilling(drilling::Setup setup, drilling::Erosion erosion, volume::ForceField field);
  bool apply_one() noexcept;
  void take(const drilling::Change& change);
  std::uint32_t free_slot();
  void loop();

  drilling::Setup setup_;
  std::mutex bone_mutex_;  // the next three: worker and onlooker, never the loop
  drilling::Erosion erosion_;
  volume::Box unshown_;
  bool worn_more_ = false;
  volume::ForceField field_;
  std::optional<models::PalpationRuntime> runtime_;
  std::vector<Slot> slots_;
  Ring<trial::Sample> samples_{kRoom};
  Ring<std::uint32_t> done_, free_;  // numbers of slots
  std::vector<trial::Sample> block_;
  std::uint32_t applied_ = 0;  // this and the next two: the loop's thread
  double now_s_ = 0.0;
  TimeHistogram lag_;  // in bins of 100 µs
  std::atomic<bool> behind_ = false, ending_ = false;
  core::Clock* clock_ = nullptr;
  std::thread thread_;
};

}  // namespace tractus::loop
