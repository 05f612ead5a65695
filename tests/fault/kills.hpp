/// How often a test kills.
#pragma once

#include <cstdlib>

namespace tractus {
/// `usual`, or what TRACTUS_KILLS says.
inline int kills(int usual) {
  const char* asked = std::getenv("TRACTUS_KILLS");
  return asked ? std::atoi(asked) : usual;
}
}  // namespace tractus
