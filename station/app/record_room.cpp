/// `tractus-station record`: a measuring room's sensors into a folder, for `tractus assemble`.
#include <fmt/format.h>

#include "core/progress.hpp"
#include "core/try.hpp"
#include "station/app/commands.hpp"

namespace tractus {
namespace app {
namespace {
std::string words_of(const sensors::Recorded& done, const std::filesystem::path& folder) {
  std::string out = fmt::format("{}: {:.1f} s", folder.string(), done.duration_s);
  if (done.calibration.rate_Hz > 0.0)
    out += fmt::format("; force: {} samples, {} lost", done.force_samples, done.force_lost);
  if (done.force_late > 0) out += fmt::format(" ({} came too late or twice)", done.force_late);
  if (done.motion_rows > 0) out += fmt::format("; motion: {} rows", done.motion_rows);
  for (const auto& [body, rows] : done.seen)
    if (rows < done.motion_rows)
      out += fmt::format(" ({} seen in {:.1f} %)", body,
                         100.0 * double(rows) / double(done.motion_rows));
  if (done.motion_damaged > 0) out += fmt::format(", {} damaged messages", done.motion_damaged);
  out += "\n";
  if (done.force_faulty > 0)
    out += fmt::format("left out: {} force samples with status {}\n", done.force_faulty,
                       sensors::status_words(done.worst_status, done.calibration.status));
  if (done.complaint)
    out += fmt::format("the motion capture said: {} {} {}\n", done.complaint->code,
                       done.complaint->name, done.complaint->message);
  if (!done.ended_by.empty())
    out += fmt::format("ended early: {}; what came before is kept\n", done.ended_by);
  else
    out += fmt::format("next: say in {} where the frames lie, then tractus assemble\n",
                       (folder / "assembly.json").string());
  return out;
}
}  // namespace

core::Result<int> record_room(const Options& options) {
  if (!options.program.empty()) return play_program(options);
  core::stop_on_signals();
  // A folder's name may end in a slash.
  const auto folder = options.room.has_filename() ? options.room : options.room.parent_path();
  const auto shown = core::terminal_progress("Recording");
  const auto done = TRY(sensors::record(options.record, folder, shown));
  if (options.json)
    fmt::print("{}\n", done.json().dump(2));
  else
    fmt::print("{}", words_of(done, folder));
  return done.ended_by.empty() ? 0 : 1;
}

}  // namespace app
}  // namespace tractus
