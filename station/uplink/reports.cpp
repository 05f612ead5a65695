#include "station/uplink/reports.hpp"

#include <algorithm>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace uplink {
namespace fs = std::filesystem;

namespace {
constexpr std::uint64_t kMaxReport_bytes = 64 * 1024;

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code failure;
  for (const auto& file : fs::directory_iterator(folder, failure))
    if (file.path().extension() == ".json") out.push_back(file.path());
  std::ranges::sort(out);
  return out;
}

bool is_final(core::Errc code) {
  return code == core::Errc::bad_input || code == core::Errc::too_large ||
         code == core::Errc::forbidden || code == core::Errc::conflict;
}
}  // namespace

core::Result<ReportsHanded> hand_over_reports(Server& server, const fs::path& folder) {
  ReportsHanded out;
  for (const fs::path& file : files_in(folder)) {
    std::error_code ignored;
    const auto bytes = core::read_file(file, kMaxReport_bytes);
    core::Result<void> sent = core::Result<void>();
    if (!bytes) {
      sent = bytes.error();
    } else {
      const Request request{.method = "POST",
                            .path = "/api/v1/station/report",
                            .headers = {{"Content-Type", "application/json"}},
                            .body = *bytes};
      auto answer = TRY(server.send(request));
      if (answer.status / 100 != 2) sent = error_of(request, answer);
    }
    if (sent) {
      fs::remove(file, ignored);
      ++out.handed_over;
    } else if (is_final(sent.error().code)) {
      out.refused.push_back(file.filename().string() + ": " + sent.error().what);
      fs::rename(file, fs::path(file).replace_extension(".refused"), ignored);
    } else {
      return sent.error();
    }
  }
  return out;
}

}  // namespace uplink
}  // namespace tractus
