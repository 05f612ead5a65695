/// Our own bugs: always on, ends the process with what was believed.
#pragma once

namespace tractus::core {

[[noreturn]] void broken_belief(const char* belief, const char* file, int line) noexcept;

/// @param belief  what must be true here, as a sentence.
inline void require(bool holds, const char* belief, const char* file = __builtin_FILE(),
                    int line = __builtin_LINE()) noexcept {
  if (!holds) [[unlikely]]
    broken_belief(belief, file, line);
}

}  // namespace tractus::core
