#include "station/headset/touching.hpp"

#include "core/try.hpp"

namespace tractus {
namespace headset {
namespace {
constexpr core::Instant_ns kPeriod_ns = 1'000'000;
constexpr double kButtonRest_s = 0.5;  // a button that was pressed for the last point still is
}  // namespace

Touch::State Touch::feed(double t_s, const math::Vec3& tip_D_m, bool pressed) {
  if (state_ != State::holding) {
    state_ = State::waiting;
    if (!pressed) return state_;
    state_ = State::holding;
    since_s_ = t_s;
    first_ = tip_D_m;
    sum_.setZero();
    samples_ = 0;
  }
  if ((tip_D_m - first_).norm() > kStill_m) return state_ = State::moved;
  sum_ += tip_D_m;
  ++samples_;
  if (t_s - since_s_ >= kHold_s) state_ = State::done;
  return state_;
}

namespace {

/// A device that took its forces away (its watchdog met a slow machine) still says where it is.
bool is_lost(devices::Status status) {
  return status == devices::Status::gone || status == devices::Status::fault;
}

core::Result<Touched> touch_point(devices::Device& device, core::Clock& clock,
                                  const FixturePoint& point, const math::Vec3& tip_H_m,
                                  const TouchExchange& talk) {
  Touch touch;
  const core::Instant_ns start = clock.now();
  bool was_down = true;  // until it was seen up
  for (core::Instant_ns due = start;; due += kPeriod_ns) {
    clock.sleep_until(due);
    if (talk.stop()) return core::Error{core::Errc::cancelled, "alignment: ended by a person"};
    devices::Sample sample;
    const core::Instant_ns now = clock.now();
    const auto read = device.read(now, sample), wrote = device.write({});
    if (is_lost(read) || is_lost(wrote))
      return core::Error{core::Errc::unavailable, "alignment: the device does not answer any more"};
    if (now > due + kPeriod_ns) due = now;  // late: not chased
    if (read != devices::Status::ok) continue;
    const double t_s = 1e-9 * double(now - start);
    const bool down = sample.buttons != 0;
    const bool button = down && !was_down && t_s > kButtonRest_s;
    was_down = down;
    const auto state = touch.feed(t_s, sample.X_DH * tip_H_m, talk.enter() || button);
    if (state == Touch::State::done) return Touched{point, touch.tip_D_m()};
    if (state == Touch::State::moved) talk.moved(point);
  }
}

}  // namespace

core::Result<std::vector<Touched>> touch_points(devices::Device& device, core::Clock& clock,
                                                std::span<const FixturePoint> points,
                                                const math::Vec3& tip_H_m,
                                                const TouchExchange& talk) {
  std::vector<Touched> out;
  for (const FixturePoint& point : points) {
    talk.ask(point);
    auto touched = TRY(touch_point(device, clock, point, tip_H_m, talk));
    out.push_back(std::move(touched));
  }
  return out;
}

}  // namespace headset
}  // namespace tractus
