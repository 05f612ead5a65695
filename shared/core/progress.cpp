#include "core/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace tractus {
namespace core {
namespace {
volatile std::sig_atomic_t stop_asked = 0;
}  // namespace

void stop_on_signals() {
  for (const int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int caught) {
      stop_asked = 1;
      std::signal(caught, SIG_DFL);
    });
}

Progress terminal_progress(std::string label) {
  if (!::isatty(STDERR_FILENO)) return [](double) { return stop_asked == 0; };
  return [label = std::move(label), shown = -1](double share) mutable {
    const int percent = std::clamp(static_cast<int>(share * 100.0), 0, 100);
    if (percent == shown) return stop_asked == 0;
    shown = percent;
    std::string bar(static_cast<std::size_t>(percent) * 30 / 100, '#');
    bar.resize(30, '.');
    std::fprintf(stderr, "\r%s [%s] %3d %%%s", label.c_str(), bar.c_str(), percent,
                 percent == 100 ? "\n" : "");
    return stop_asked == 0;
  };
}

}  // namespace core
}  // namespace tractus
