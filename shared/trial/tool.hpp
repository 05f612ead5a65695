/// With what a trial was done: one word for the messages and the database.
#pragma once

#include "core/named.hpp"

namespace tractus::trial {

enum class Tool {
  probe,
  burr,  ///< the trial drilled
};
constexpr auto words(Tool) {
  return std::to_array<core::Word<Tool>>({{Tool::probe, "probe"}, {Tool::burr, "burr"}});
}
using core::name;

}  // namespace tractus::trial
