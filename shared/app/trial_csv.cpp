#include "app/trial_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "core/bytes.hpp"
#include "core/file.hpp"

namespace tractus {
namespace commands {
namespace fs = std::filesystem;
namespace {
constexpr const char* kProbingColumns =
    "t_s,x_m,theta_rad,fz_N,tz_Nm,speed_m_s,turning_rad_s,command_m_s,command_Nm,law_m_s,"
    "round_trip_s,tick,mode,fault,flags\n";
constexpr const char* kColumns =
    "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,"
    "rendered_fx_N,rendered_fy_N,rendered_fz_N,rendered_tx_Nm,rendered_ty_Nm,rendered_tz_Nm,"
    "deflection_x_m,deflection_y_m,tick,iterations,flags\n";
}  // namespace

core::Result<TrialCsv> TrialCsv::create(const fs::path& path) {
  const fs::path beside = path.string() + fmt::format(".{}.part", core::hex(core::random_bytes(4)));
  std::FILE* file = std::fopen(beside.c_str(), "wxe");
  if (!file) return core::system_error(path, "cannot create");
  return TrialCsv(path, beside, file);
}

TrialCsv::~TrialCsv() {
  if (file_) ::unlink(beside_.c_str());
}

void TrialCsv::add_header(trial::Rig rig) {
  if (!headed_) std::fputs(rig == trial::Rig::probing ? kProbingColumns : kColumns, file_.get());
  headed_ = true;
}

void TrialCsv::add(const trial::Block& block) {
  add_header(block.probing.empty() ? trial::Rig::palpation : trial::Rig::probing);
  fmt::memory_buffer rows;
  for (const auto& s : block.palpation)
    fmt::format_to(std::back_inserter(rows), "{},{},{},{},{},{},{},{},{},{},{}\n", s.t_s,
                   fmt::join(s.p_VH_m, ","), fmt::join(s.q_VH, ","), fmt::join(s.force_N, ","),
                   fmt::join(s.torque_Nm, ","), fmt::join(s.rendered_force_N, ","),
                   fmt::join(s.rendered_torque_Nm, ","), fmt::join(s.deflection_m, ","), s.tick,
                   s.iterations, s.flags);
  for (const auto& s : block.probing)
    fmt::format_to(std::back_inserter(rows), "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                   s.t_s, s.x_m, s.theta_rad, s.fz_N, s.tz_Nm, s.speed_m_s, s.turning_rad_s,
                   s.command_m_s, s.command_Nm, s.law_m_s, s.round_trip_s, s.tick,
                   trial::name(s.mode), s.fault, s.flags);
  std::fwrite(rows.data(), 1, rows.size(), file_.get());
}

core::Result<void> TrialCsv::finish(trial::Rig rig) {
  add_header(rig);
  std::FILE* file = file_.release();
  const bool failed =
      std::fflush(file) != 0 || std::ferror(file) != 0 || ::fsync(::fileno(file)) != 0;
  core::Error error = core::system_error(path_, "cannot write");
  std::fclose(file);
  if (const auto free = core::may_be_replaced(path_); !free) {
    ::unlink(beside_.c_str());
    return free.error();
  }
  if (!failed && ::rename(beside_.c_str(), path_.c_str()) == 0) return {};
  if (!failed) error = core::system_error(path_, "cannot put in place");
  ::unlink(beside_.c_str());
  return error;
}

}  // namespace commands
}  // namespace tractus
