/// The published table of forces and torques: mean, standard deviation and maximum of what is above
/// the sensor's floor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "math/geometry.hpp"

namespace tractus::replay {

/// A column of the table.
struct WrenchColumn {
  std::string_view id;     ///< "force_xy_N"
  std::string_view label;  ///< "F_xy"
  std::string_view unit;   ///< "N"
  double floor;            ///< what is not above it stays out
  double (*signed_value)(
      const math::Wrench& wrench_H);  ///< along z with its sign; across z the (positive) length
};

/// F_xy, F_z, T_xy, T_z [Zoller2020, Table 1]: lengths in the plane across the handle's axis,
/// values along it; floors 0.01 N and 0.001 N·m.
extern const std::array<WrenchColumn, 4> kChannels;

/// Over the samples whose amount is above the floor: |F_z| and |T_z| for the axial ones.
struct Summary {
  std::uint64_t samples = 0;  ///< all
  std::uint64_t above = 0;    ///< those that count; mean needs one, sd two, or they are NaN
  double mean, sd, max;       ///< sd with n − 1 (the source does not say)
};

Summary summary(std::span<const math::Wrench> wrenches, const WrenchColumn& channel);

/// One line of the table: who, measured or simulated, a summary per channel.
struct Row {
  std::string scope;   ///< "all", "operator", "trial"
  std::string name;    ///< operator's name or trial's id; empty for all
  std::string source;  ///< "measured" or "simulated"
  std::array<Summary, 4> channels;
};

Row row(std::string scope, std::string name, std::string source,
        std::span<const math::Wrench> wrenches);

/// Tidy CSV: scope,name,source,channel,samples,above_floor,mean,sd,max; a number that does not
/// exist is an empty cell.
std::string csv(std::span<const Row> rows);
/// For a terminal, laid out as Tables 1 and 2 of the source. Names are cut to fit.
std::string printed(std::span<const Row> rows);
core::Json to_json(const Row& row);

}  // namespace tractus::replay
