#define GL_GLEXT_PROTOTYPES
#include "station/headset/gpu_timer.hpp"

#include <GL/gl.h>
#include <GL/glext.h>

namespace tractus::headset {

GpuTimer::GpuTimer() {
  for (auto& turn : queries_) glGenQueries(kEyes, turn.data());
}

GpuTimer::~GpuTimer() {
  for (auto& turn : queries_) glDeleteQueries(kEyes, turn.data());
}

void GpuTimer::begin() {
  const auto turn = static_cast<std::size_t>(turn_);
  if (asked_[turn] < kEyes)
    glBeginQuery(GL_TIME_ELAPSED, queries_[turn][static_cast<std::size_t>(asked_[turn])]);
}

void GpuTimer::end() {
  const auto turn = static_cast<std::size_t>(turn_);
  if (asked_[turn] >= kEyes) return;
  glEndQuery(GL_TIME_ELAPSED);
  ++asked_[turn];
}

std::optional<double> GpuTimer::frame_s() {
  turn_ = 1 - turn_;
  const auto turn = static_cast<std::size_t>(turn_);
  const int asked = asked_[turn];
  asked_[turn] = 0;
  if (asked != kEyes) return std::nullopt;
  double sum_s = 0.0;
  for (const unsigned query : queries_[turn]) {
    GLint there = 0;
    glGetQueryObjectiv(query, GL_QUERY_RESULT_AVAILABLE, &there);
    if (!there) return std::nullopt;
    GLuint64 ns = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &ns);
    sum_s += 1e-9 * static_cast<double>(ns);
  }
  return sum_s;
}

}  // namespace tractus::headset
