#include "station/loop/drilling.hpp"

#include <cmath>
#include <utility>

#include "core/try.hpp"

namespace tractus {
namespace loop {
namespace {
constexpr std::size_t kSlots = 8, kBlock = 256;
constexpr core::Instant_ns kPoll_ns = 500'000;
}  // namespace

core::Result<std::unique_ptr<Drilling>> Drilling::make(const volume::Volume& bone,
                                                       models::PalpationModel model,
                                                       const drilling::Burr& burr,
                                                       const core::Progress& progress) {
  auto& base = model.base;
  base.radius_m = burr.shank_radius_m;
  auto erosion = TRY(
      drilling::Erosion::make(bone, model.transfer, burr,
                              {.length_m = base.length_m, .pose_offset_m = base.pose_offset_m}));
  auto field = TRY(volume::ForceField::make(bone, model.transfer, model.field, progress));
  std::unique_ptr<Drilling> made(
      new Drilling({burr, model.transfer}, std::move(erosion), std::move(field)));
  auto runtime = TRY(models::PalpationRuntime::make(model, made->field_));
  made->runtime_.emplace(std::move(runtime));
  return made;
}

Drilling::Drilling(drilling::Setup setup, drilling::Erosion erosion, volume::ForceField field)
    : setup_(std::move(setup)),
      erosion_(std::move(erosion)),
      field_(std::move(field)),
      slots_(kSlots),
      done_(kSlots),
      free_(kSlots),
      block_(kBlock) {
  for (std::uint32_t slot = 0; slot < kSlots; ++slot) free_.push(slot);
}

Drilling::~Drilling() {
  ending_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

bool Drilling::apply_one() noexcept {
  std::uint32_t slot = 0;
  if (done_.pop({&slot, 1}) == 0) return false;
  field_.apply(slots_[slot].patch);
  lag_.add(std::llround((now_s_ - slots_[slot].t_s) * 1e7));
  ++applied_;
  free_.push(slot);
  return true;
}

std::uint32_t Drilling::apply(double t_s) noexcept {
  now_s_ = t_s;
  apply_one();
  return applied_;
}

void Drilling::worked(const trial::Sample& sample) noexcept {
  if (!samples_.push(sample)) behind_.store(true, std::memory_order_relaxed);
}

void Drilling::start(core::Clock& clock) {
  core::require(!thread_.joinable(), "a drilling is started once");
  clock_ = &clock;
  thread_ = std::thread([this] { loop(); });
}

void Drilling::loop() {
  while (!ending_.load(std::memory_order_relaxed)) {
    work();
    clock_->sleep_until(clock_->now() + kPoll_ns);
  }
}

void Drilling::work() {
  const drilling::Erosion::Take taking = [this](const drilling::Change& change) { take(change); };
  for (;;) {
    const std::size_t taken = samples_.pop(block_);
    if (taken == 0) return;
    const std::lock_guard lock(bone_mutex_);
    for (std::size_t i = 0; i < taken; ++i) {
      erosion_.add(block_[i], taking);
      worn_more_ = worn_more_ || (block_[i].flags & trial::kPressed);
    }
  }
}

// A patch that is not in use. With a thread of its own the loop gives them back; without, this is
// the loop's thread and does so itself.
std::uint32_t Drilling::free_slot() {
  std::uint32_t slot = 0;
  while (free_.pop({&slot, 1}) == 0 && !ending_.load(std::memory_order_relaxed)) {
    if (clock_)
      clock_->sleep_until(clock_->now() + kPoll_ns / 10);
    else
      apply_one();
  }
  return slot;
}

void Drilling::take(const drilling::Change& change) {
  unshown_ = drilling::united(unshown_, change.box);
  if (ending_.load(std::memory_order_relaxed)) return;  // nobody feels it any more
  const std::uint32_t slot = free_slot();
  if (ending_.load(std::memory_order_relaxed)) return;
  field_.compute(erosion_.volume(), change.box, slots_[slot].patch);
  slots_[slot].t_s = change.t_s;
  done_.push(slot);
}

void Drilling::finish() {
  ending_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
  work();
  const std::lock_guard lock(bone_mutex_);
  erosion_.finish([this](const drilling::Change& change) { take(change); });
  worn_more_ = true;  // the last dose
}

std::optional<volume::Box> Drilling::show(volume::Volume& shown) {
  // The worker may hold it until the loop gives a patch back, and the loop end meanwhile: no wait.
  const std::unique_lock lock(bone_mutex_, std::try_to_lock);
  if (!lock) return std::nullopt;
  const volume::Box box = std::exchange(unshown_, {});
  if (box.begin[0] >= box.end[0]) return std::nullopt;
  const volume::Volume& now = erosion_.volume();
  const auto width = std::ptrdiff_t(box.end[0] - box.begin[0]);
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      const auto at = std::ptrdiff_t(now.offset(box.begin[0], j, k));
      std::copy_n(now.counts.begin() + at, width, shown.counts.begin() + at);
    }
  return box;
}

std::optional<drilling::ErodedShares> Drilling::worn() {
  const std::unique_lock lock(bone_mutex_, std::try_to_lock);
  if (!lock || !std::exchange(worn_more_, false)) return std::nullopt;
  return drilling::worn_of(erosion_);
}

}  // namespace loop
}  // namespace tractus
