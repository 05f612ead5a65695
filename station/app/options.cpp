#include "station/app/options.hpp"

#include <cstdio>
#include <ctime>
#include <limits>
#include <map>

#include "station/app/commands.hpp"
#include "station/app/option_parts.hpp"

namespace tractus {
namespace app {
namespace {
constexpr const char* kExamples = R"(Examples:
  tractus-station trust  --data st --case case/                 accept cases with this signature
  tractus-station --device sim-lambda6 --case case/ --data st   a trial in real time, SIMULATED hand
  tractus-station --case undrilled/ --data st --tool burr       drill the channel; then palpate it:
  tractus-station --case undrilled/ --data st --drilled 0193c8… with the id that the drilling printed
  tractus-station --case 3f9ac2d1 --data st --speed fast --seed 7 --trials 5 --json
  tractus-station --case 3f9ac2d1 --data st --server http://127.0.0.1:8480 --token-file st.token
  tractus-station --device sim-rig --scenario lateral_breach --data st --speed fast   SIMULATED rig
  tractus-station --device rig --address 192.168.1.40:1502 --scenario mine.json --data st
  tractus-station study  --study spine-1 --participant P01 --device rig --data st --server URL --token-file st.token
  tractus-station enrol  --server https://sim.example.org:8480 --authority authority.pem --code C --token-file st.token
  tractus-station assigned --badge 4711 --data st --server URL --token-file st.token
  tractus-station kiosk  --data st --server URL --token-file st.token --web web/dist   assigned, on a full screen
  tractus-station --device lambda6 --sdk /opt/sdk --case 3f9ac2d1 --data st
  tractus-station --device lambda6 --case 3f9ac2d1 --data st --view headset
  tractus-station align  --device lambda6 --data st --fixture table.json   place of the device in the room
  tractus-station sync   --data st --server URL --token-file st.token
  tractus-station upload --data st --server URL --token-file st.token --wait 600
  tractus-station record --netft 192.168.1.1 --igtl tracker.local --body probe --body bone --out room/
  tractus-station self-test --device lambda6 --data st --page today.html
  tractus-station calibrate --device rig --address 192.168.1.40:1502 --data st --who Ada)";

const std::map<std::string, session::Speed> kSpeeds{{"real", session::Speed::real},
                                                    {"fast", session::Speed::fast}};

const std::map<std::string, loop::Passivity> kPassivities{
    {"observed", loop::Passivity::observed}, {"controlled", loop::Passivity::controlled}};

const std::map<std::string, bool> kTools{{"probe", false}, {"burr", true}};

/// "2026-03-02T09:30Z" → microseconds since 1970.
std::optional<std::int64_t> utc_from(const std::string& text) {
  std::tm fields{};
  const char* end = ::strptime(text.c_str(), "%Y-%m-%dT%H:%MZ", &fields);
  if (!end || *end != '\0') return std::nullopt;
  return std::int64_t{::timegm(&fields)} * 1'000'000;
}

void add_started(CLI::App& app, Options& options) {
  app.add_option_function<std::string>(
         "--started",
         [&options](const std::string& text) { options.started_utc_us = utc_from(text); },
         "with --speed fast: a SIMULATED date for the first trial, like 2026-03-02T09:30Z; each "
         "further one ten minutes later")
      ->check([](const std::string& text) {
        return utc_from(text) ? std::string()
                              : text + ": a time like 2026-03-02T09:30Z is expected";
      });
}

void add_rig(CLI::App& app, Options& options) {
  add_address(app, options);
  app.add_option("--rate", options.rig.rate_Hz, "Hz, of the rig's loop")
      ->check(between(100.0, 1000.0))
      ->capture_default_str();
  app.add_option("--skill", options.rig.skill, "of a simulated rig's surgeon, 0 … 1")
      ->check(between(0.0, 1.0))
      ->capture_default_str();
  app.add_flag("!--no-surgeon", options.rig.surgeon,
               "a simulated rig: only what is written to it moves it");
}

/// A handle, or a rig for what is probed; an unknown name is refused by the trial.
void add_any_device(CLI::App& app, Options& options, const char* probed) {
  using devices::DeviceKind;
  app.add_option("--device", options.setup.device,
                 fmt::format("{}; {} {}", devices::listed(DeviceKind::handle),
                             devices::listed(DeviceKind::rig), probed))
      ->capture_default_str();
}

void add_tune(CLI::App& app, Options& options) {
  add_data(app, options, true);
  add_rig(app, options);
  app.add_option("--scenario", options.scenario, "to begin with: a file, or one that ships")
      ->required();
  app.add_option("--who", options.who, "the expert, as new versions name him")->required();
  app.add_option("--out", options.tuned_folder, "folder for new versions, named by their id")
      ->required();
  add_device(app, options.rig.device, "", devices::all(devices::DeviceKind::rig));
  app.add_option("--seed", options.rig.seed, "of a simulated rig's surgeon")->capture_default_str();
  app.add_option("--speed", options.rig.speed, "real or fast")->transform(word_of(kSpeeds));
  app.add_option("--duration", options.rig.duration_s, "s, of a trial at most")
      ->check(between(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--trials", options.trials, "how many, one after the other")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.footer(
      "Example:\n  tractus-station tune --data st --device rig --address 192.168.1.40:1502 "
      "--scenario hard --who \"Dr. A\" --out scenarios/");
}

void add_run(CLI::App& app, Options& options) {
  add_any_device(app, options, "for a scenario");
  app.add_option("--tool", options.burr,
                 "probe: the channel is felt; burr: the bone is drilled while the device's button "
                 "is held (a case of tractus carve --no-channel)")
      ->transform(word_of(kTools))
      ->default_str("probe");
  app.add_option("--burr", options.burr_file,
                 "JSON file with the burr's numbers, with --tool burr");
  app.add_option("--drilled", options.drilled,
                 "palpate what this trial drilled into the case: its id");
  add_sdk(app, options);
  app.add_option("--case", options.case_name,
                 "a case's folder, or 8 or more characters of the id of one in the data folder");
  app.add_option("--model", options.model_file,
                 "feel the case, or the scenario's bone, by this model: a file, or the name of one "
                 "that was sent here");
  app.add_option("--scenario", options.scenario,
                 "a scenario's file, or hard, soft, lateral_breach, in_out_in: those that ship");
  add_rig(app, options);
  app.add_option("--seed", options.setup.seed, "of the simulated hand; +1 for each further trial")
      ->check(between(0.0, 9e15))
      ->capture_default_str();
  app.add_option("--duration", options.setup.duration_s, "s, of the trial; on the rig at most")
      ->check(between(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--speed", options.setup.speed,
                 "real, or fast: simulated time, as fast as it goes")
      ->transform(word_of(kSpeeds));
  app.add_option("--passivity", options.setup.passivity,
                 "observed: energy given to the hand is logged; controlled: and damped away")
      ->transform(word_of(kPassivities));
  app.add_option("--answer", options.answer, "what to answer instead of the simulated hand")
      ->check(CLI::IsMember({"none", "medial", "lateral", "superior", "inferior", "anterior"}));
  app.add_option("--trials", options.trials, "how many, one after the other")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--view", options.show,
                 "window; headset (OpenXR); headset-or-window: a window when there is no headset; "
                 "offscreen "
                 "(drawn, not shown); none")
      ->transform(word_of(shows()))
      ->default_str("none");
  app.add_option("--picture", options.picture,
                 "PNG of the (last) trial: bone cut open, what was drilled, tool, the tip's way");
  app.add_option(
      "--igtl-out", options.igtl_out,
      "[ADDRESS:]PORT at which 3D Slicer and others may listen to the tip's pose and the "
      "forces by OpenIGTLink, 60 times a second (default: none; address 127.0.0.1)");
  app.add_flag("--follow", options.follow,
               "a JSON line on standard error whenever samples have reached the disk");
}

void add_study(CLI::App& app, Options& options) {
  app.add_option("--study", options.study, "the study's short name")->required();
  app.add_option("--participant", options.participant, "a pseudonym")->required();
  add_device(app, options.rig.device, "; a simulated one for a simulated participant",
             devices::all(devices::DeviceKind::rig));
  add_address(app, options);
  app.add_option("--skill", options.rig.skill,
                 "of the simulated surgeon, 0 … 1; without, it follows from their experience")
      ->check(between(0.0, 1.0));
  app.add_option("--seed", options.rig.seed, "of the simulated surgeons")
      ->check(between(0.0, 9e15))
      ->capture_default_str();
  app.add_option("--speed", options.rig.speed,
                 "real, or fast: simulated time, a simulated rig alone")
      ->transform(word_of(kSpeeds));
  add_started(app, options);
  app.add_option("--trials", options.trials, "at most so many now; all that are left if not given")
      ->check(CLI::Range(1, 1000));
  app.add_flag("--follow", options.follow,
               "a JSON line on standard error whenever samples have reached the disk");
}

void set_study(const CLI::App& app, Options& options) {
  options.skill_given = app.count("--skill") > 0;
  if (app.count("--trials") == 0) options.trials = std::numeric_limits<int>::max();
}

/// What `assigned` and `kiosk` have in common: who does the trials comes, what they are is the
/// server's.
void add_assigned_trials(CLI::App& app, Options& options) {
  add_data(app, options, true);
  add_server(app, options, true);
  add_any_device(app, options, "for scenarios");
  add_sdk(app, options);
  add_rig(app, options);
  app.add_option("--seed", options.setup.seed, "of the simulated hand")
      ->check(between(0.0, 9e15))
      ->capture_default_str();
  app.add_option("--duration", options.setup.duration_s, "s, of a palpation trial")
      ->check(between(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--view", options.show, "window, headset, headset-or-window, offscreen or none")
      ->transform(word_of(shows()))
      ->default_str("none");
}

void add_assigned(CLI::App& app, Options& options) {
  add_assigned_trials(app, options);
  app.add_option("--badge", options.badge, "the trainee's badge number")->required();
  app.add_option("--pin-file", options.pin_file, "its first line is the PIN; else asked for");
  add_started(app, options);
  app.add_option("--speed", options.setup.speed, "real or fast")->transform(word_of(kSpeeds));
  app.add_option("--answer", options.answer, "what to answer instead of the simulated hand")
      ->check(CLI::IsMember({"none", "medial", "lateral", "superior", "inferior", "anterior"}));
  app.add_option("--trials", options.trials, "at most so many now")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
}

void add_kiosk(CLI::App& app, Options& options) {
  add_assigned_trials(app, options);
  app.add_option("--web", options.web, "folder of the built pages (web/dist)")->required();
  app.add_option("--port", options.port,
                 "on 127.0.0.1, where the browser finds it; 0: any free one")
      ->capture_default_str();
  auto* none = app.add_flag("--no-browser", options.no_browser,
                            "print the page's address; whoever has it drives the kiosk");
  app.add_option("--browser", options.browser, "program that shows the page")
      ->capture_default_str()
      ->excludes(none);
  app.add_option("--study", options.study,
                 "for participants of this blind study alone, on a rig: each types the "
                 "pseudonym, and there is no PIN");
  app.add_option("--idle", options.idle_s,
                 "s without a touch between trials; then the trainee is signed out")
      ->check(between(5.0, 3600.0))
      ->capture_default_str();
  app.add_option("--technician-pin-file", options.technician_pin_file,
                 "its first line is the PIN of the technician's menu; without, there is none");
  app.footer(
      "Examples:\n"
      "  tractus-station kiosk --data st --server URL --token-file st.token --web web/dist "
      "--device rig --address 192.168.1.40:1502\n"
      "  tractus-station kiosk --data st --server URL --token-file st.token --web web/dist "
      "--device sim-rig --no-browser   SIMULATED rig\n"
      "deploy/systemd/tractus-kiosk.service starts it with the machine.");
}

void add_enrol(CLI::App& app, Options& options) {
  app.add_flag("--json", options.json, "one JSON document on standard output");
  app.add_option("--data", options.data,
                 "the station's folder: cases that are made on the server are taken there");
  add_server(app, options, true);
  app.add_option("--code", options.code, "from the server's administrator; holds an hour")
      ->required();
}

void add_trust(CLI::App& app, Options& options) {
  add_data(app, options, true);
  auto* key = app.add_option("--signer", options.signer_hex, "public key, 64 hexadecimal digits");
  auto* bundle = app.add_option("--case", options.signer_of_case, "a case: its signer's key");
  key->excludes(bundle);
}

/// Palpation or probing? What does not fit is refused.
std::optional<int> check_run(const CLI::App& app, Options& options) {
  session::RigSetup& rig = options.rig;
  rig.device = options.setup.device;
  if (devices::is_rig(rig.device)) options.command = run_probing_trials;
  if (options.data.empty()) return refuse("--data is required");
  if (options.command == run_trials) {
    if (!options.scenario.empty())
      return refuse(fmt::format("--scenario: --device {} is expected",
                                devices::listed(devices::DeviceKind::rig)));
    if (!options.burr && !options.burr_file.empty()) return refuse("--burr: needs --tool burr");
    if (options.burr && !options.drilled.empty())
      return refuse("--drilled: is palpated, with --tool probe; a burr begins on the case's bone");
    return options.case_name.empty() ? std::optional(refuse("--case is required")) : std::nullopt;
  }
  const std::string handles = devices::listed(devices::DeviceKind::handle);
  if (!options.case_name.empty())
    return refuse(fmt::format("--case: is felt with {}, not on the rig", handles));
  if (options.scenario.empty() && options.model_file.empty())
    return refuse("--scenario is required (or --model alone, without walls)");
  if (options.burr || !options.drilled.empty())
    return refuse(fmt::format("--tool, --drilled: are of a case, with {}", handles));
  if (options.show != Show::none || !options.picture.empty() || !options.igtl_out.empty())
    return refuse("--view, --picture, --igtl-out: the rig has none; its person feels alone");
  rig.seed = options.setup.seed;
  rig.speed = options.setup.speed;
  if (app.count("--duration") > 0) rig.duration_s = options.setup.duration_s;
  return std::nullopt;
}
}  // namespace

CLI::App* add_command(CLI::App& app, Options& options, CommandFunction command, const char* name,
                      const char* what) {
  CLI::App* added = app.add_subcommand(name, what);
  added->callback([&options, command] { options.command = command; });
  return added;
}

void add_data(CLI::App& app, Options& options, bool needed) {
  auto* data = app.add_option("--data", options.data, "the station's folder; made when missing");
  if (needed) data->required();
  app.add_flag("--json", options.json, "one JSON document on standard output");
}

CLI::Option* add_device(CLI::App& app, std::string& device, const std::string& help,
                        const std::vector<devices::DeviceInfo>& from) {
  std::vector<std::string> ids;
  for (const devices::DeviceInfo& info : from) ids.push_back(info.id);
  return app.add_option("--device", device, devices::listed(from) + help)
      ->check(CLI::IsMember(ids))
      ->capture_default_str();
}

void add_sdk(CLI::App& app, Options& options) {
  app.add_option("--sdk", options.setup.sdk,
                 devices::listed(devices::AddressedBy::sdk) +
                     ": the vendor's SDK, its folder or library; else $FDSDK, else as installed");
}

void add_address(CLI::App& app, Options& options) {
  app.add_option("--address", options.rig.address,
                 devices::listed(devices::AddressedBy::line) +
                     ": HOST:PORT, or a serial line /dev/…[@BAUD]")
      ->capture_default_str();
}

void add_server(CLI::App& app, Options& options, bool needed) {
  auto* url = app.add_option("--server", options.server_url, "http(s)://HOST:PORT");
  auto* token = app.add_option("--token-file", options.token_file, "file with the station's token");
  url->needs(token);
  app.add_option("--authority", options.authority,
                 "PEM file of the certificate authority to trust (the server's tls/authority.pem)");
  if (needed) url->required();
}

int refuse(const std::string& why) {
  std::fprintf(stderr, "tractus-station: %s (see --help)\n", why.c_str());
  return 2;
}

const std::map<std::string, Show>& shows() {
  static const std::map<std::string, Show> all{{"none", Show::none},
                                               {"window", Show::window},
                                               {"offscreen", Show::offscreen},
                                               {"headset", Show::headset},
                                               {"headset-or-window", Show::headset_or_window}};
  return all;
}

Parsed parse(int argc, char** argv) {
  Parsed out;
  Options& options = out.options;
  options.command = run_trials;
  CLI::App app("A station: feel a case with a haptic device, record the trial, hand it over",
               "tractus-station");
  app.set_version_flag("--version", TRACTUS_VERSION);
  app.footer(kExamples);
  app.require_subcommand(0, 1);
  add_data(app, options, false);
  add_server(app, options, false);
  add_run(app, options);

  CLI::App* sync =
      add_command(app, options, sync_cases, "sync", "download the cases of the server");
  add_data(*sync, options, true);
  add_server(*sync, options, true);
  CLI::App* study =
      add_command(app, options, run_study, "study", "run a participant's trials of a blind study");
  add_data(*study, options, true);
  add_server(*study, options, true);
  add_study(*study, options);
  CLI::App* upload =
      add_command(app, options, upload_trials, "upload", "upload the trials that wait");
  add_data(*upload, options, true);
  add_server(*upload, options, true);
  upload->add_option("--wait", options.wait_s, "s to retry if the server does not answer")
      ->check(between(0.0, 1e7));
  add_assigned(*add_command(app, options, run_assigned, "assigned",
                            "sign in with badge and PIN and run the assigned trials in order"),
               options);
  add_kiosk(*add_command(app, options, run_kiosk, "kiosk",
                         "show a full-screen page where trainees sign in and do assigned trials"),
            options);
  add_enrol(*add_command(app, options, enrol_station, "enrol",
                         "register this station at the server with a one-time code"),
            options);
  add_tune(
      *add_command(
          app, options, tune_scenario, "tune",
          "change the eight parameters of a scenario by keys while it is felt; save new versions"),
      options);
  add_trust(*add_command(app, options, trust_signer, "trust",
                         "accept cases that are signed with this key"),
            options);
  add_technician(app, options);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& failure) {
    out.leave = failure.get_exit_code() == 0 ? app.exit(failure) : refuse(failure.what());
    return out;
  }
  if (study->parsed()) set_study(*study, options);
  if (options.command == trust_signer && options.signer_hex.empty() &&
      options.signer_of_case.empty())
    out.leave = refuse("trust: --signer or --case is expected");
  if (auto refused = check_technician(options)) out.leave = refused;
  if (options.command == run_trials) out.leave = check_run(app, options);
  return out;
}

}  // namespace app
}  // namespace tractus
