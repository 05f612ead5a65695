/// `tractus record`: the station's recorder, for who looks for it here. This program speaks to no
/// device; it becomes `tractus-station record`, which lies beside it, with the same arguments.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "app/command.hpp"

namespace tractus {
namespace commands {
namespace {
Outcome become_station(const std::vector<std::string>& arguments) {
  std::error_code failure;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", failure);
  const std::string station = (own.parent_path() / "tractus-station").string();
  std::vector<std::string> words{"tractus-station", "record"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  if (!failure) ::execv(station.c_str(), argv.data());
  return core::Error{core::Errc::not_found,
                     fmt::format("record: this program cannot access devices; run tractus-station "
                                 "record, which is expected at {} ({})",
                                 station, std::strerror(errno))};
}
}  // namespace

Command record_command() {
  return {.name = "record",
          .summary = "Record a force/torque sensor and motion capture (tractus-station record)",
          .example =
              "tractus record --netft 192.168.1.1 --igtl tracker.local --body probe "
              "--body vertebra --for 90 --out room/",
          .make = [](CLI::App& app) -> std::function<Outcome()> {
            app.set_help_flag();  // the station's help is the one that is meant
            app.prefix_command();
            return [&app] { return become_station(app.remaining()); };
          }};
}

}  // namespace commands
}  // namespace tractus
