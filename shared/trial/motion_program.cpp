#include "trial/motion_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/try.hpp"

namespace tractus {
namespace trial {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr double kLongest_s = 600.0;

/// A stage's way from rest to rest: speed rises and falls as half a cosine, constant between.
class Way {
 public:
  Way(double from, double to, double speed, double acceleration)
      : from_(from), direction_(to < from ? -1.0 : 1.0) {
    const double distance = std::abs(to - from);
    speed_ = std::min(speed, std::sqrt(distance * acceleration));
    rise_s_ = distance > 0.0 ? speed_ / acceleration : 0.0;
    even_s_ = distance > 0.0 ? distance / speed_ - rise_s_ : 0.0;
  }
  double seconds() const { return 2.0 * rise_s_ + even_s_; }

  struct State {
    double at, rate, acceleration;
  };
  State state(double t_s) const {
    const double all = seconds();
    if (t_s <= 0.0 || rise_s_ <= 0.0)
      return {from_ + direction_ * (t_s < all ? 0.0 : way()), 0.0, 0.0};
    if (t_s >= all) return {from_ + direction_ * way(), 0.0, 0.0};
    if (t_s < rise_s_) return signed_state(risen(t_s));
    if (t_s > rise_s_ + even_s_) {
      State back = risen(all - t_s);
      return signed_state({way() - back.at, back.rate, -back.acceleration});
    }
    return signed_state({0.5 * speed_ * rise_s_ + speed_ * (t_s - rise_s_), speed_, 0.0});
  }

 private:
  double way() const { return speed_ * (rise_s_ + even_s_); }
  State risen(double t_s) const {
    const double w = std::numbers::pi / rise_s_;
    return {0.5 * speed_ * (t_s - std::sin(w * t_s) / w), 0.5 * speed_ * (1.0 - std::cos(w * t_s)),
            0.5 * speed_ * w * std::sin(w * t_s)};
  }
  State signed_state(State s) const {
    return {from_ + direction_ * s.at, direction_ * s.rate, direction_ * s.acceleration};
  }

  double from_, direction_, speed_ = 0.0, rise_s_ = 0.0, even_s_ = 0.0;
};

/// A move of both stages.
struct Leg {
  Way slide, turn;
  double seconds;
};

std::vector<Leg> legs(const MotionProgram& program) {
  std::vector<Leg> out;
  double x = program.start_m, theta = program.start_rad;
  for (const Move& move : program.moves) {
    const Way slide(x, move.to_m, move.speed_m_s, program.acceleration_m_s2);
    const Way turn(theta, move.to_rad, move.speed_rad_s, program.acceleration_rad_s2);
    out.push_back({slide, turn, std::max(slide.seconds(), turn.seconds()) + move.hold_s});
    x = move.to_m, theta = move.to_rad;
  }
  return out;
}

Result<double> number_in(const Json& json, const char* field, const std::string& where, double low,
                         double high) {
  const auto it = json.find(field);
  if (it == json.end() || !it->is_number() || !std::isfinite(it->get<double>()))
    return Error{Errc::bad_input, fmt::format("{}{}: a number is expected", where, field)};
  const double value = it->get<double>();
  if (value < low || value > high)
    return Error{Errc::bad_input, fmt::format("{}{}: {:.6g} lies outside {:.6g} to {:.6g}", where,
                                              field, value, low, high)};
  return value;
}

}  // namespace

double MotionProgram::seconds() const {
  double out = 0.0;
  for (const Leg& leg : legs(*this)) out += leg.seconds;
  return out;
}

PlannedMotion MotionProgram::motion(double spacing_s) const {
  PlannedMotion out;
  const auto all = legs(*this);
  double begun_s = 0.0;
  std::size_t at = 0;
  const auto count = std::size_t(seconds() / spacing_s) + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = double(i) * spacing_s;
    while (at + 1 < all.size() && t - begun_s >= all[at].seconds) begun_s += all[at++].seconds;
    const Way::State x = all[at].slide.state(t - begun_s), theta = all[at].turn.state(t - begun_s);
    out.t_s.push_back(t);
    out.x_m.push_back(x.at), out.v_m_s.push_back(x.rate), out.a_m_s2.push_back(x.acceleration);
    out.theta_rad.push_back(theta.at), out.omega_rad_s.push_back(theta.rate);
  }
  return out;
}

Json MotionProgram::to_json() const {
  Json list = Json::array();
  for (const Move& move : moves)
    list.push_back({{"to_m", move.to_m},
                    {"speed_m_s", move.speed_m_s},
                    {"to_rad", move.to_rad},
                    {"speed_rad_s", move.speed_rad_s},
                    {"hold_s", move.hold_s}});
  return {{"format", "tractus-program/1"},
          {"rig", "probing"},
          {"name", name},
          {"words", words},
          {"start_m", start_m},
          {"start_rad", start_rad},
          {"acceleration_m_s2", acceleration_m_s2},
          {"acceleration_rad_s2", acceleration_rad_s2},
          {"moves", std::move(list)}};
}

Result<MotionProgram> MotionProgram::from_json(const Json& json, const std::string& where) {
  const auto wrong = [&](const std::string& what) { return Error{Errc::bad_input, where + what}; };
  if (!json.is_object() || json.value("format", "") != "tractus-program/1")
    return wrong("format: \"tractus-program/1\" is expected");
  if (json.value("rig", "") != "probing")
    return wrong("rig: only the rig \"probing\" plays programs");
  MotionProgram out;
  out.name = json.value("name", "");
  out.words = json.value("words", "");
  out.start_m = TRY(number_in(json, "start_m", where, -0.2, 0.2));
  out.start_rad = TRY(number_in(json, "start_rad", where, -100.0, 100.0));
  out.acceleration_m_s2 = TRY(number_in(json, "acceleration_m_s2", where, 1e-3, 100.0));
  out.acceleration_rad_s2 = TRY(number_in(json, "acceleration_rad_s2", where, 1e-3, 1e4));
  const auto moves = json.find("moves");
  if (moves == json.end() || !moves->is_array() || moves->empty())
    return wrong("moves: at least one move is expected");
  for (std::size_t k = 0; k < moves->size(); ++k) {
    const std::string at = fmt::format("{}moves/{}/", where, k);
    const Json& move = (*moves)[k];
    if (!move.is_object()) return Error{Errc::bad_input, at + ": an object is expected"};
    out.moves.push_back({.to_m = TRY(number_in(move, "to_m", at, -0.2, 0.2)),
                         .speed_m_s = TRY(number_in(move, "speed_m_s", at, 1e-5, 1.0)),
                         .to_rad = TRY(number_in(move, "to_rad", at, -100.0, 100.0)),
                         .speed_rad_s = TRY(number_in(move, "speed_rad_s", at, 1e-4, 40.0)),
                         .hold_s = TRY(number_in(move, "hold_s", at, 0.0, 60.0))});
  }
  if (out.seconds() > kLongest_s)
    return wrong(
        fmt::format("takes {:.0f} s; at most {:.0f} s are played", out.seconds(), kLongest_s));
  return out;
}

}  // namespace trial
}  // namespace tractus
