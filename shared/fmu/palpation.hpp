/// A model of the palpation rig as an FMU: its variables, and what the FMU carries of model and volume.
#pragma once

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "fmu/variables.hpp"
#include "models/model.hpp"

namespace tractus::fmu {

/// The first variables of every model of this rig, in this order; vectors and the quaternion have a
/// place for each component. The other parameters follow.
enum class PalpationPlace : std::size_t {
  p_m = 0,
  q = 3,  ///< w x y z
  v_m_s = 7,
  omega_rad_s = 10,
  a_m_s2 = 13,
  alpha_rad_s2 = 16,
  force_N = 19,
  torque_Nm = 22,
  deflection_m = 25,
  converged = 27,
  down = 28,
  base = 31
};

/// What an FMU carries beside the model.
struct CarriedField {
  volume::StoredOpacity part;
  math::Vec3 down = -math::Vec3::UnitZ();  ///< unit vector along gravity, in V
};

/// The most voxels that are carried: 512 MiB.
inline constexpr std::size_t kMostCarriedVoxels = std::size_t(1) << 27;

/// The start values are the model's numbers.
std::vector<Variable> variables(const models::PalpationModel& model, const math::Vec3& down);

struct PalpationNumbers {
  models::PalpationModel model;
  math::Vec3 down;  ///< unit vector
};
/// The model with other numbers, one value per variable. Errors: bad_input or out_of_range naming the
/// parameter; a delay below 0, for a force cannot come before its motion here.
core::Result<PalpationNumbers> with_parameters(const models::PalpationModel& model,
                                               std::span<const Variable> variables,
                                               std::span<const double> values);

/// The model as an FMU carries it: every number is stated, in the order of `variables`; no volume.
std::string carried_text(models::PalpationModel model);

/// `tractus-field/1`: all of the field but the opacities, of which it has the digest.
std::string field_text(const CarriedField& field);
/// Little-endian floats [k][j][i].
core::ByteView opacity_bytes(const CarriedField& field);
/// Errors: bad_input naming the field; corrupt where the digest is another's.
/// @param where  leads every message, as "field.json: "
core::Result<CarriedField> read_field(std::string_view text, core::ByteView opacities,
                                      const std::string& where);

}  // namespace tractus::fmu
