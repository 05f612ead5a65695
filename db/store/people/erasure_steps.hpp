/// The statements of an erasure, in their order. Only erasure.cpp and its test use them.
#pragma once

#include "db/store/people/erasure.hpp"

namespace tractus::store {

/// A statement over the person's rows of one table. :account, :name, :badge, :alias and :number stand for values.
struct ErasureStep {
  std::string table;
  std::optional<ErasureMode> only;  ///< none: in both modes
  std::string sql;                  ///< without "returning"
};
const std::vector<ErasureStep>& erasure_steps();

}  // namespace tractus::store
