/// The options of what a technician does.

#include <set>

#include "station/app/commands.hpp"
#include "station/app/option_parts.hpp"

namespace tractus {
namespace app {
namespace {
constexpr std::size_t kLongestName = 64;

void add_align(CLI::App& app, Options& options) {
  add_data(app, options, true);
  add_device(app, options.setup.device, "; a simulated one touches the points by itself",
             devices::all(devices::DeviceKind::handle));
  add_sdk(app, options);
  app.add_option(
         "--fixture", options.fixture,
         "the points to touch, in the headset's STAGE frame (m, y up): {\"format\": "
         "\"tractus-fixture/1\", \"points\": [{\"name\": \"A\", \"stage_m\": [x, y, z]}, …]}")
      ->required();
  app.add_option("--tip", options.tip_mm,
                 "mm from the handle's origin along the handle to what touches the points")
      ->check(between(-300.0, 300.0))
      ->capture_default_str();
  app.add_option("--limit", options.limit_mm, "mm that a point may be off")
      ->check(between(0.1, 20.0))
      ->capture_default_str();
}

/// What self-test and calibrate share.
void add_check(CLI::App& app, Options& options) {
  add_data(app, options, true);
  add_server(app, options, false);
  add_device(app, options.setup.device, "", devices::all());
  add_sdk(app, options);
  add_address(app, options);
  app.add_option("--rate", options.rig.rate_Hz, "Hz, of the rig's loop")
      ->check(between(100.0, 1000.0))
      ->capture_default_str();
  app.add_option("--page", options.page, "the report as a page to print, HTML");
  app.add_flag("--stand-by", options.stand_by,
               "a person stands by and knows what will move: nobody is asked at the terminal");
}

void add_self_test(CLI::App& app, Options& options) {
  add_check(app, options);
  app.preparse_callback([&options](std::size_t) { options.show = Show::offscreen; });
  app.add_option("--for", options.for_s, "s, that a hand moves the handle to its ends")
      ->check(between(1.0, 120.0))
      ->capture_default_str();
  std::map<std::string, Show> timed = shows();
  std::erase_if(timed, [](const auto& one) { return one.first.starts_with("headset"); });
  app.add_option("--view", options.show, "the display that is timed: window, offscreen or none")
      ->transform(word_of(timed))
      ->default_str("offscreen");
  app.footer(
      "Exit 0 all passed, 1 something did not, 2 bad use. A simulated device needs nobody.\n"
      "Example:\n  tractus-station self-test --device lambda6 --data st --page today.html");
}

void add_calibrate(CLI::App& app, Options& options) {
  add_check(app, options);
  app.add_option("--who", options.who, "who does it, as the record names them")->required();
  app.add_option("--due-days", options.due_days, "days until the next one")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str();
  app.footer(
      "lambda6: its handle moves by itself to find its zero. Exit 0 noted, 1 not, 2 bad use.\n"
      "Example:\n  tractus-station calibrate --device lambda6 --data st --who Ada --due-days 90");
}

void add_threshold(CLI::App& app, Options& options) {
  add_data(app, options, true);
  add_server(app, options, false);
  add_device(app, options.setup.device, "; a simulated one is held by a SIMULATED person",
             devices::all(devices::DeviceKind::handle));
  add_sdk(app, options);
  app.add_option("--who", options.who, "who answers, as the file names them")->required();
  app.add_option("--out", options.out, "the new file, JSON; tractus carve --observer takes it")
      ->required();
  app.add_option("--questions", options.questions, "of each of three stimuli")
      ->check(CLI::Range(10, 200))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "of what is drawn by chance")->capture_default_str();
  app.footer(
      "Two-interval forced choices: the least push that is felt, the least difference from 1 N, "
      "the "
      "least gap of a wall; some ten minutes.\n"
      "Example:\n  tractus-station threshold --device lambda6 --data st --who Ada --out ada.json");
}

void add_record(CLI::App& app, Options& options) {
  sensors::RecordSetup& record = options.record;
  app.add_option("--out", options.room, "the recording's new folder; must not exist")->required();
  app.add_option("--netft", record.netft_host, "ATI Net F/T sensor: its host name or address");
  app.add_option("--igtl", record.igtl_host, "motion capture over OpenIGTLink: its host");
  app.add_option("--body", record.bodies, "of the capture system, once for each: the tool first")
      ->needs("--igtl");
  app.add_option("--for", record.for_s, "s; ends sooner by Ctrl-C, which keeps what there is")
      ->check(between(0.1, 86'400.0))
      ->capture_default_str();
  app.add_flag("--bias", record.bias,
               "the sensor takes what it feels now as its zero; without, assemble takes it off");
  const auto port = CLI::Range(1, 65'535);
  app.add_option("--netft-port", record.netft_port, "UDP, of RDT")
      ->check(port)
      ->capture_default_str();
  app.add_option("--http-port", record.http_port, "of the sensor's page")
      ->check(port)
      ->capture_default_str();
  app.add_option("--igtl-port", record.igtl_port, "TCP")->check(port)->capture_default_str();
  app.add_option("--program", options.program,
                 "the probing rig plays this motion by itself instead (tractus-program/1, from "
                 "tractus diagnose "
                 "--next-recording), through what is clamped before its probe; --out becomes a "
                 "measurement set");
  const auto rigs = devices::all(devices::DeviceKind::rig);
  add_device(app, options.setup.device, ", with --program", rigs)->needs("--program");
  add_address(app, options);
  app.add_option("--repetitions", options.repetitions, "trials of the program")
      ->needs("--program")
      ->check(CLI::Range(1, 50))
      ->capture_default_str();
  app.add_option("--with", options.with_set,
                 "a measurement set whose trials come first in the new one")
      ->needs("--program");
  app.add_option("--specimen", options.specimen,
                 "of a simulated rig: the SIMULATED material before the probe (tractus-specimen/1)")
      ->needs("--program");
  app.add_flag("--stand-by", options.stand_by,
               "a person stands by and knows what will move: nobody is asked");
  app.add_flag("--json", options.json, "one JSON document on standard output");
  app.footer(
      "Example:\n  tractus-station record --netft 192.168.1.1 --igtl tracker.local --body probe "
      "--body vertebra --for 90 --out room/\nThen tap five times, palpate, tap five times again; "
      "complete room/assembly.json; tractus assemble.");
}

std::optional<int> check_record(const Options& options) {
  const sensors::RecordSetup& record = options.record;
  if (!options.program.empty()) {
    if (!record.netft_host.empty() || !record.igtl_host.empty())
      return refuse("record: --program records the rig's own sensors: without --netft and --igtl");
    return std::nullopt;
  }
  if (record.netft_host.empty() && record.igtl_host.empty())
    return refuse("record: --netft or --igtl is expected, or both");
  if (!record.igtl_host.empty() && record.bodies.empty())
    return refuse("record: --igtl: --body is expected, once for each body that is kept");
  if (std::set(record.bodies.begin(), record.bodies.end()).size() < record.bodies.size())
    return refuse("record: --body: each body once");
  for (const std::string* host : {&record.netft_host, &record.igtl_host})
    if (host->find_first_of("/@ ?#") != std::string::npos)
      return refuse("record: '" + *host + "': a host's name or address alone is expected");
  for (const std::string& body : record.bodies)
    if (body.empty() || body.find_first_of(",\"\n\r") != std::string::npos)
      return refuse("record: --body: a name without commas, quotes and line breaks is expected");
  return std::nullopt;
}

}  // namespace

void add_technician(CLI::App& app, Options& options) {
  CLI::App* limits = add_command(app, options, show_limits, "limits",
                                 "show the limits of force; --restore undoes remote reductions");
  add_data(*limits, options, true);
  limits->add_flag("--restore", options.restore, "use this station's own limits again");
  add_self_test(*add_command(app, options, self_test, "self-test",
                             "test device, loop, display, disk and clock"),
                options);
  add_calibrate(
      *add_command(app, options, calibrate, "calibrate",
                   "find and check the zero of the device, and note when calibration is due again"),
      options);
  add_threshold(*add_command(app, options, measure_thresholds, "threshold",
                             "measure what a person can tell by force at this device"),
                options);
  add_align(
      *add_command(app, options, align_room, "align",
                   "touch three points with the handle so that the headset shows it in its place"),
      options);
  add_record(*add_command(
                 app, options, record_room, "record",
                 "record a force/torque sensor and motion capture together for a measurement set"),
             options);
}

std::optional<int> check_technician(const Options& options) {
  if (options.who.size() > kLongestName) return refuse("--who: at most 64 bytes");
  return options.command == record_room ? check_record(options) : std::nullopt;
}

}  // namespace app
}  // namespace tractus
