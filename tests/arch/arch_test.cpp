/// Who may include whom: the table of the architecture, held against every #include of the tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <checkout.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace tractus {
namespace {
namespace fs = std::filesystem;
using Names = std::set<std::string>;

const fs::path kRoot = checkout::kSource;

/// Folder → folders its files may include (itself always). Only `*/app` sees everything on its
/// side.
const std::map<std::string, Names> kAllowed = {
    {"shared/core", {}},
    {"shared/math", {"shared/core"}},
    {"shared/statistics", {"shared/core", "shared/math"}},
    {"shared/volume", {"shared/core", "shared/math"}},
    {"shared/volume/io", {"shared/core", "shared/math", "shared/volume"}},
    {"shared/laws", {"shared/core", "shared/math", "shared/volume"}},
    {"shared/effects", {"shared/core", "shared/math", "shared/volume", "shared/laws"}},
    {"shared/models",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects"}},
    {"shared/lab",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects",
      "shared/models", "shared/trial", "shared/statistics", "shared/plot"}},
    // The lab's edge: files and zips in, a problem ready to judge out.
    {"shared/lab/io",
     {"shared/core", "shared/math", "shared/volume", "shared/volume/io", "shared/laws",
      "shared/effects", "shared/models", "shared/trial", "shared/statistics", "shared/plot",
      "shared/lab"}},
    // A model for other tools: described and zipped here, run by the shared object of module/.
    {"shared/fmu",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects",
      "shared/models", "shared/plot", "shared/lab/io"}},
    // A scenario is the probing law's numbers as an expert tunes them; its bone is a model's.
    {"shared/scenarios",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects",
      "shared/models"}},
    // What server and station share of a blind study: its orders, and a law sealed for a station.
    {"shared/study", {"shared/core", "shared/math", "shared/volume", "shared/laws"}},
    {"shared/cases",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects",
      "shared/models"}},
    {"shared/trial", {"shared/core", "shared/math"}},
    // A measuring room's files become a measurement set.
    {"shared/capture", {"shared/core", "shared/math", "shared/trial"}},
    // What a burr takes from a volume: a function of a trial's samples.
    {"shared/drilling", {"shared/core", "shared/math", "shared/volume", "shared/trial"}},
    {"shared/metrics", {"shared/core", "shared/math", "shared/volume", "shared/trial"}},
    // Analyses of a cohort: tables in, findings and pictures out.
    {"shared/assessment",
     {"shared/core", "shared/math", "shared/statistics", "shared/trial", "shared/metrics",
      "shared/plot"}},
    {"shared/wire", {"shared/core", "shared/math", "shared/trial"}},
    {"shared/tracing", {"shared/core"}},
    {"shared/plot", {"shared/core"}},
    // The replay's pictures and tables are of a recording and a model together; recorded depths are
    // smoothed as the lab smooths them, or the two would disagree on the same files.
    {"shared/replay",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/models", "shared/trial",
      "shared/plot", "shared/lab"}},
    {"db/store", {"shared/core", "shared/trial"}},
    // Whether a hand may be given anything: no device, no loop, no model.
    {"station/safety", {"shared/core", "shared/math"}},
    {"station/devices", {"shared/core", "shared/math"}},
    // The rig's electronics and mechanics, played by a process: the register map, and no law.
    {"station/rig", {"shared/core", "station/devices"}},
    // What measures people and machines; never in the haptic loop.
    {"station/sensors", {"shared/core", "shared/math"}},
    {"station/loop",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects",
      "shared/models", "shared/trial", "shared/drilling", "station/devices", "station/safety"}},
    // Tests of devices and of this machine: every force passes through the loop's limiters.
    {"station/check",
     {"shared/core", "shared/math", "shared/plot", "shared/statistics", "station/devices",
      "station/loop", "station/safety"}},
    // How volumes are stored in bricks: those that are here are not fetched.
    {"station/uplink",
     {"shared/core", "shared/trial", "shared/wire", "shared/cases", "shared/volume",
      "shared/tracing"}},
    {"station/view",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/models", "shared/cases",
      "shared/trial", "shared/drilling"}},  // the burr, and what it took
    // The window's picture, for two eyes; a device's handle touches points when the room is
    // aligned.
    {"station/headset",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/drilling",
      "station/view", "station/devices"}},
    // The kiosk's states, and its page by the server's own transport; no device, no loop.
    {"station/kiosk",
     {"shared/core", "shared/math", "shared/trial", "shared/wire", "shared/volume", "server/http"}},
    {"station/session",
     {"shared/core", "shared/math", "shared/volume", "shared/laws", "shared/effects",
      "shared/models", "shared/scenarios", "shared/cases", "shared/trial", "shared/metrics",
      "shared/wire", "shared/drilling", "station/devices", "station/loop", "station/uplink",
      "station/rig"}},  // the simulated rig without its bus, for trials in simulated time
    {"server/http", {"shared/core"}},
    // Reading a CT (volume/io) is work of a process of its own; its key is the api's to hand over.
    // A cohort's statistics are the plans of shared/assessment on a table of the store's trials.
    {"server/jobs",
     {"shared/core", "shared/trial", "shared/metrics", "shared/cases", "shared/scenarios",
      "shared/volume", "shared/volume/io", "shared/lab", "shared/lab/io", "shared/assessment",
      "shared/tracing", "db/store"}},
    // What stations do just now: their words, the database they share, lines to those who look on.
    {"server/live", {"shared/core", "shared/wire", "db/store", "server/http"}},
    // The effects' labels are part of the API's description, so that pages need none of their own.
    {"server/api",
     {"server/live", "shared/core", "shared/math", "shared/trial", "shared/effects",
      "shared/metrics", "shared/cases", "shared/scenarios", "shared/study", "shared/volume",
      "shared/wire", "shared/models", "shared/assessment", "shared/statistics", "shared/lab/io",
      "shared/tracing", "db/store", "server/http", "server/jobs"}},
};

bool is_source(const fs::path& path) {
  return path.extension() == ".hpp" || path.extension() == ".cpp";
}

std::vector<fs::path> sources() {
  std::vector<fs::path> out;
  for (const char* top : {"shared", "db", "server", "station"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top))
      if (entry.is_regular_file() && is_source(entry.path())) out.push_back(entry.path());
  std::ranges::sort(out);
  return out;
}

/// The folder of the table that a path (relative to the root) lies in: the longest that fits.
std::string layer_of(const std::string& path) {
  std::string best;
  for (const auto& [folder, _] : kAllowed)
    if (path.starts_with(folder + "/") && folder.size() > best.size()) best = folder;
  return best;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// A test, or what the tests of a folder share.
bool is_of_tests(const std::string& relative) {
  return relative.ends_with("_test.cpp") || relative.ends_with("_test_support.hpp");
}

std::string layer_included(const std::string& quoted) {
  for (const auto& candidate : {"shared/" + quoted, quoted})
    if (fs::exists(kRoot / candidate)) return layer_of(candidate);
  return "";
}

TEST(Architecture, IncludesFollowTheTable) {
  const std::regex include("#include \"([^\"]+)\"");
  for (const auto& path : sources()) {
    const std::string relative = fs::relative(path, kRoot).string();
    if (relative.find("/app/") != std::string::npos || is_of_tests(relative)) continue;
    const std::string layer = layer_of(relative);
    ASSERT_FALSE(layer.empty()) << relative << " lies in no folder of the table";
    const std::string text = text_of(path);
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
      const std::string to = layer_included((*it)[1]);
      ASSERT_FALSE(to.empty()) << relative << " includes " << (*it)[1]
                               << ", which lies in no folder of the table";
      EXPECT_TRUE(to == layer || kAllowed.at(layer).contains(to))
          << relative << " must not include " << (*it)[1];
    }
  }
}

/// nlohmann's own entry points limit neither depth nor width: core/json.cpp alone calls them.
TEST(Architecture, JsonIsParsedByCoreAlone) {
  const std::regex parser("[Jj]son::(parse|accept|sax_parse|from_[a-z]+) *\\(|nlohmann(::|/)");
  int calls_in_core = 0;
  for (const auto& path : sources()) {
    const std::string relative = fs::relative(path, kRoot).string();
    if (is_of_tests(relative)) continue;
    const std::string text = text_of(path);
    const bool calls = std::regex_search(text, parser);
    if (relative.starts_with("shared/core/json."))
      calls_in_core += calls;
    else
      EXPECT_FALSE(calls) << relative << " must parse JSON with core::parse_json";
  }
  EXPECT_EQ(calls_in_core, 2) << "the expression no longer finds the one place that is allowed";
}

/// A guard without a name ends in the line that takes it: TRY(lock()) would guard nothing.
TEST(Architecture, GuardsHaveANameBeyondTry) {
  const std::regex guard("(^|[;{}])[ \\n]*TRY\\([^;]*(\\b(hold_upload|hold|lock)|Lock::take)\\(");
  EXPECT_TRUE(std::regex_search(std::string("{\n  TRY(FolderLock::take(path));"), guard));
  EXPECT_FALSE(std::regex_search(std::string(";\n  const auto held = TRY(hold(x));"), guard));
  for (const auto& path : sources()) {
    const std::string text = text_of(path);
    for (std::size_t at = 0; (at = text.find("TRY(", at)) != std::string::npos; ++at) {
      const std::size_t from = text.find_last_of(";{}", at);
      const std::string statement = text.substr(from + 1, text.find('\n', at) - from);
      EXPECT_FALSE(std::regex_search(statement, guard)) << path << ": " << statement;
    }
  }
}

/// Trials reach research through the filter of db/store/cohort/released.hpp alone: the rows with names are
/// for the page of a trainee, and whoever else includes them is named here after somebody thought
/// about it.
TEST(Architecture, RowsOfTrialsWithNamesAreForThoseWhoTeachAlone) {
  Names readers;
  for (const auto& path : sources()) {
    const std::string relative = fs::relative(path, kRoot).string();
    if (relative.starts_with("db/store/")) continue;
    const std::string text = text_of(path);
    for (const char* word : {"db/store/cohort/cohort.hpp", "trials_for_teaching", "CohortTrial"})
      if (text.find(word) != std::string::npos) readers.insert(relative);
  }
  // Who has passed is for teachers, and for oneself.
  EXPECT_EQ(readers, (Names{"server/api/studies/criteria_routes.cpp",
                            "server/api/studies/passing.cpp", "server/api/studies/passing.hpp",
                            "server/api/studies/trainees.cpp", "server/api/studies/trainees.hpp"}));
}

/// The blind generators are a second implementation: what they include must not exist in the
/// product, and no target of it may be linked.
TEST(Architecture, BlindGeneratorsShareNothingWithTheProduct) {
  const std::regex include("#include [\"<]([^\">]+)[\">]");
  const fs::path blind = kRoot / "tests/blind";
  int read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(blind)) {
    if (!entry.is_regular_file() || !is_source(entry.path())) continue;
    const std::string text = text_of(entry.path());
    ++read;
    for (std::sregex_iterator it(text.begin(), text.end(), include), end; it != end; ++it) {
      const std::string name = (*it)[1];
      if (fs::exists(blind / name)) continue;
      for (const char* top : {".", "shared", "tests", "db", "server", "station"})
        EXPECT_FALSE(fs::exists(kRoot / top / name)) << entry.path() << " includes " << name;
      EXPECT_EQ(name.find(".."), std::string::npos) << entry.path() << " includes " << name;
    }
  }
  EXPECT_GT(read, 10);
  EXPECT_EQ(text_of(blind / "CMakeLists.txt").find("tractus::"), std::string::npos);
}

std::string without_comments(const std::string& text) {
  return std::regex_replace(text, std::regex("//[^\n]*"), "");
}

/// The ids of the effects' catalogues, which are the names of their files.
Names effect_ids() {
  Names out;
  for (const char* rig : {"probing", "palpation"})
    for (const auto& entry : fs::directory_iterator(kRoot / "shared/effects" / rig))
      if (entry.path().extension() == ".cpp") out.insert(entry.path().stem().string());
  return out;
}

/// A text that is an id, begins a parameter's name ("ID/…"), or is the first words of an id.
std::regex names_an_effect(const Names& ids) {
  std::string whole, parts;
  for (const std::string& id : ids) {
    whole += (whole.empty() ? "" : "|") + id;
    for (auto at = id.find('_'); at != std::string::npos; at = id.find('_', at + 1))
      parts += (parts.empty() ? "" : "|") + id.substr(0, at + 1);
  }
  return std::regex("\"((" + whole + ")[\"/]|(" + parts + ")\")", std::regex::optimize);
}

/// What is known of an effect is in its file and asked of its facts; who names one elsewhere knows
/// what the next effect's file cannot tell him.
TEST(Architecture, AnEffectIsNamedInItsOwnFileAlone) {
  const Names ids = effect_ids();
  ASSERT_GT(ids.size(), 20u);
  const std::regex named = names_an_effect(ids);
  const auto found = [&](const std::string& code) {
    return std::regex_search(without_comments(code), named);
  };
  EXPECT_TRUE(found(R"(use.id == "sensor_drift")"));
  EXPECT_TRUE(found(R"(id.starts_with("rotary_"))"));
  EXPECT_TRUE(found(R"(p.pointer == "pose_offset/offset_m")"));
  EXPECT_FALSE(found(R"(return {"contact_share";)"));
  EXPECT_FALSE(found(R"(std::string id;  ///< "coulomb_friction")"));
  for (const auto& path : sources()) {
    const std::string relative = fs::relative(path, kRoot).string();
    if (relative.starts_with("shared/effects/") || is_of_tests(relative)) continue;
    EXPECT_FALSE(found(text_of(path))) << relative << " names an effect: ask its facts";
  }
}

TEST(Architecture, EveryFolderOfTheTableSaysWhatItIs) {
  for (const auto& [folder, _] : kAllowed) {
    if (!fs::exists(kRoot / folder)) continue;
    EXPECT_TRUE(fs::exists(kRoot / folder / "README.md")) << folder << " has no README.md";
  }
}

/// A test's file that no target compiles is a promise that nobody checks.
TEST(Architecture, EveryTestIsCompiled) {
  std::string built = text_of(fs::path(TRACTUS_BINARY_DIR) / "compile_commands.json");
  if (built.empty()) GTEST_SKIP() << "built without CMAKE_EXPORT_COMPILE_COMMANDS";
  for (const auto& entry :
       fs::recursive_directory_iterator(TRACTUS_BINARY_DIR))  // several files compiled as one
    if (entry.path().filename().string().starts_with("unity_")) built += text_of(entry.path());
  for (const char* top : {"shared", "db", "server", "station", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      const std::string file = entry.path().string();
      if (!file.ends_with("_test.cpp")) continue;
      EXPECT_NE(built.find(file), std::string::npos) << file << " belongs to no target";
    }
}

TEST(Architecture, HeadersAreGuardedAndWithoutUsingNamespace) {
  for (const auto& path : sources()) {
    if (path.extension() != ".hpp") continue;
    const std::string text = text_of(path);
    EXPECT_NE(text.find("#pragma once"), std::string::npos) << path;
    EXPECT_EQ(text.find("using namespace"), std::string::npos) << path;
  }
}

TEST(Architecture, PrintsTheTenLargestSources) {
  std::vector<std::pair<long, std::string>> sizes;
  for (const auto& path : sources()) {
    const std::string text = text_of(path);
    sizes.emplace_back(std::ranges::count(text, '\n'), fs::relative(path, kRoot).string());
  }
  std::ranges::sort(sizes, std::greater<>());
  for (std::size_t i = 0; i < std::min<std::size_t>(10, sizes.size()); ++i)
    std::printf("%5ld  %s\n", sizes[i].first, sizes[i].second.c_str());
  ASSERT_FALSE(sizes.empty());
  EXPECT_LE(sizes.front().first, 500) << sizes.front().second << " has grown too large: split it";
}

}  // namespace
}  // namespace tractus
