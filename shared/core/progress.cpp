#include "core/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace core {

Progress terminal_progress(std::string label) {
  if (!::isatty(STDERR_FILENO)) return [](double) { return true; };
  return [label = std::move(label), shown = -1](double share) mutable {
    const int percent = std::clamp(static_cast<int>(share * 100.0), 0, 100);
    if (percent == shown) return true;
    shown = percent;
    std::string bar(static_cast<std::size_t>(percent) * 30 / 100, '#');
    bar.resize(30, '.');
    std::fprintf(stderr, "\r%s [%s] %3d %%%s", label.c_str(), bar.c_str(), percent,
                 percent == 100 ? "\n" : "");
    return true;
  };
}

}  // namespace core
