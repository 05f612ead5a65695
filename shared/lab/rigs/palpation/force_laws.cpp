#include "lab/rigs/palpation/force_laws.hpp"

#include <Eigen/Geometry>
#include <utility>

#include "lab/settings.hpp"
#include "lab/signal/fading_memory.hpp"

namespace tractus {
namespace lab {
namespace {

using math::Mat3;
using math::Vec3;
using Vectors = std::vector<Vec3>;

constexpr const auto& kLaws = kSettings.laws;

/// A vector's mean over the time before, by a first-order lag.
Vectors lagged(std::span<const double> t_s, const Vectors& value, double time_s) {
  Vectors out(value.size());
  std::vector<double> column(value.size());
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < value.size(); ++k) column[k] = value[k](axis);
    const std::vector<double> memory = fading_memory(t_s, column, time_s);
    for (std::size_t k = 0; k < value.size(); ++k) out[k](axis) = memory[k] / time_s;
  }
  return out;
}

class Laws {
 public:
  explicit Laws(const Contact& contact) : contact_(contact), n_(contact.t_s.size()) {
    for (std::size_t k = 0; k < n_; ++k) {
      const Vec3 F = contact.force_V_N[k], v = contact.tip_v_m_s[k];
      const Vec3 along = F.norm() > kLaws.least_N ? Vec3(F.normalized()) : Vec3(Vec3::Zero());
      const Vec3 across = v - along * along.dot(v);
      force_.push_back(F), along_.push_back(along);
      friction_.push_back(F.norm() / (across.norm() + kLaws.least_speed_m_s) * across);
    }
  }

  std::vector<ForceLaws::Law> all() {
    add("what is known", known());
    add("a contact that stiffens or softens with depth",
        {in_room([&](std::size_t k) { return depth_m(k) * force_[k]; }),
         in_room([&](std::size_t k) { return depth_m(k) * depth_m(k) * force_[k]; })});
    add("a contact that stiffens or softens with time",
        {in_room([&](std::size_t k) { return contact_.t_s[k] * force_[k]; })});
    add("bone that is stiffer one way", of_bone());
    add("the contact force of before", memories(force_));
    add("the friction of before", memories(friction_));
    add("damping that grows with depth", {in_room([&](std::size_t k) {
          return Vec3(force_[k].norm() > kLaws.touch_N ? Vec3(depth_m(k) * contact_.tip_v_m_s[k])
                                                       : Vec3(Vec3::Zero()));
        })});
    return std::move(out_);
  }

 private:
  void add(const char* name, std::vector<Eigen::Matrix3Xd> terms) {
    out_.push_back({name, std::move(terms)});
  }
  template <class Value>
  Eigen::Matrix3Xd in_room(Value value) const {
    return in_handle([&](std::size_t k) { return Vec3(to_handle(k) * Vec3(value(k))); });
  }
  template <class Value>
  Eigen::Matrix3Xd in_handle(Value value) const {
    Eigen::Matrix3Xd out(3, Eigen::Index(n_));
    for (std::size_t k = 0; k < n_; ++k) out.col(Eigen::Index(k)) = value(k);
    return out;
  }
  math::Quat to_handle(std::size_t k) const { return contact_.handle[k].X_VH.q.conjugate(); }
  double depth_m(std::size_t k) const {
    return contact_.depth_m.empty() ? 0.0 : contact_.depth_m[k];
  }

  /// The force of the model, larger or smaller, of another curve or a little earlier; the sensor's constant error and
  /// cross-talk; the probe's weight; friction, damping and the hand's motion. The catalogue has effects for them.
  std::vector<Eigen::Matrix3Xd> known() const {
    const auto& v = contact_.tip_v_m_s;
    const auto& handle = contact_.handle;
    std::vector<Eigen::Matrix3Xd> out{
        in_room([&](std::size_t k) { return force_[k].norm() * force_[k]; }),
        in_room([&](std::size_t k) { return force_[k].squaredNorm() * force_[k]; }),
        in_room([&](std::size_t k) { return along_[k]; }),
        in_room([&](std::size_t k) { return rate_N_s(k); }),
        in_room([&](std::size_t k) { return friction_[k]; }),
        in_room([&](std::size_t k) { return v[k]; }),
        in_room([&](std::size_t k) { return Vec3(force_[k].norm() * v[k]); }),
        in_room([&](std::size_t k) { return Vec3(v[k].norm() * v[k]); }),
        in_room([&](std::size_t k) {
          return Vec3(along_[k].dot(v[k]) * force_[k].norm() * along_[k]);
        }),
        in_room([&](std::size_t k) { return handle[k].v_m_s; }),
        in_room([&](std::size_t k) { return handle[k].omega_rad_s; }),
        in_room([&](std::size_t k) { return Vec3(handle[k].omega_rad_s.cross(handle[k].v_m_s)); })};
    for (int i = 0; i < 3; ++i) {
      out.push_back(in_room([&](std::size_t) { return Vec3::Unit(i); }));
      out.push_back(in_handle([&](std::size_t) { return Vec3::Unit(i); }));
      for (int j = 0; j < 3; ++j)
        out.push_back(in_handle(
            [&](std::size_t k) { return Vec3((to_handle(k) * force_[k])(j)*Vec3::Unit(i)); }));
    }
    return out;
  }

  Vec3 rate_N_s(std::size_t k) const {
    const std::size_t a = k > 0 ? k - 1 : k, b = std::min(k + 1, n_ - 1);
    const double step_s = contact_.t_s[b] - contact_.t_s[a];
    return step_s > 0.0 ? Vec3((force_[b] - force_[a]) / step_s) : Vec3(Vec3::Zero());
  }

  /// Linear in the contact force, by a symmetric matrix that is constant in the room.
  std::vector<Eigen::Matrix3Xd> of_bone() const {
    std::vector<Eigen::Matrix3Xd> out;
    for (int i = 0; i < 2; ++i)  // the zz is among the rest and the model's own force
      for (int j = i; j < 3; ++j) {
        Mat3 M = Mat3::Zero();
        M(i, j) = M(j, i) = 1.0;
        out.push_back(in_room([&](std::size_t k) { return Vec3(M * force_[k]); }));
      }
    return out;
  }

  std::vector<Eigen::Matrix3Xd> memories(const Vectors& of) const {
    std::vector<Eigen::Matrix3Xd> out;
    for (const double time_s : kLaws.memories_s) {
      const Vectors before = lagged(contact_.t_s, of, time_s);
      out.push_back(in_room([&](std::size_t k) { return Vec3(before[k] - of[k]); }));
    }
    return out;
  }

  const Contact& contact_;
  const std::size_t n_;
  Vectors force_, along_, friction_;
  std::vector<ForceLaws::Law> out_;
};

}  // namespace

Felt felt_by(const models::PalpationRuntime& model, const PalpationRecording& r) {
  models::PalpationAnswer at;
  model.predict_at(r.motion, r.all(), r.deflection_m, at);
  Felt out;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto& h = r.motion.handle[i];
    const Vec3 shank_m = model.law().parameters().length_m * (h.X_VH.q * Vec3::UnitZ());
    out.tip_m.push_back(model.tip_m(h.X_VH, at.deflection_m[i]));
    out.velocity_m_s.push_back(h.v_m_s + h.omega_rad_s.cross(shank_m));
    out.force_H_N.push_back(at.wrench_H[i].force_N);
    out.force_V_N.push_back(h.X_VH.q * at.wrench_H[i].force_N);
  }
  return out;
}

std::vector<ForceLaws::Law> force_laws_of(const Contact& contact) { return Laws(contact).all(); }

}  // namespace lab
}  // namespace tractus
