#include "station/app/options.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

namespace app {
namespace {
constexpr const char* kExamples = R"(Examples:
  tractus-station trust  --data st --case case/                 whose cases this station takes
  tractus-station --device sim-lambda6 --case case/ --data st   a trial in real time, SIMULATED hand
  tractus-station --case 3f9ac2d1 --data st --speed fast --seed 7 --trials 5 --json
  tractus-station --case 3f9ac2d1 --data st --server http://127.0.0.1:8480 --token-file st.token
  tractus-station sync   --data st --server URL --token-file st.token
  tractus-station upload --data st --server URL --token-file st.token --wait 600)";

const std::map<std::string, session::Speed> kSpeeds{{"real", session::Speed::real},
                                                    {"fast", session::Speed::fast}};

const std::map<std::string, Show> kShows{
    {"none", Show::none}, {"window", Show::window}, {"offscreen", Show::offscreen}};

void add_data(CLI::App& app, Options& options, bool needed) {
  auto* data = app.add_option("--data", options.data, "the station's folder; made when missing");
  if (needed) data->required();
  app.add_flag("--json", options.json, "one JSON document on standard output");
}

void add_server(CLI::App& app, Options& options, bool needed) {
  auto* url = app.add_option("--server", options.server_url, "http(s)://HOST:PORT");
  auto* token = app.add_option("--token-file", options.token_file, "file with the station's token");
  url->needs(token);
  if (needed) url->required();
}

void add_run(CLI::App& app, Options& options) {
  app.add_option("--device", options.setup.device, "which device: sim-lambda6")
      ->capture_default_str();
  app.add_option("--case", options.case_name,
                 "a case's folder, or 8 or more characters of the id of one in the data folder");
  app.add_option("--model", options.model_file, "feel the case by this model instead of its own");
  app.add_option("--seed", options.setup.seed, "of the simulated hand; +1 for each further trial")
      ->check(CLI::Range(0.0, 9e15))
      ->capture_default_str();
  app.add_option("--duration", options.setup.duration_s, "s, of the trial")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  app.add_option("--speed", options.setup.speed,
                 "real, or fast: simulated time, as fast as it goes")
      ->transform(CLI::CheckedTransformer(kSpeeds));
  app.add_option("--answer", options.answer, "what to answer instead of the simulated hand")
      ->check(CLI::IsMember({"none", "medial", "lateral", "superior", "inferior", "anterior"}));
  app.add_option("--trials", options.trials, "how many, one after the other")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--view", options.show, "window, offscreen (drawn, not shown) or none")
      ->transform(CLI::CheckedTransformer(kShows))
      ->default_str("none");
  app.add_option("--picture", options.picture,
                 "PNG of the (last) trial: bone cut open, probe, the tip's way");
  app.add_flag("--follow", options.follow,
               "a JSON line on standard error whenever samples have reached the disk");
}

int refuse(const std::string& why) {
  std::fprintf(stderr, "tractus-station: %s (see --help)\n", why.c_str());
  return 2;
}
}  // namespace

Parsed parse(int argc, char** argv) {
  Parsed out;
  Options& options = out.options;
  CLI::App app("A station: feel a case with a haptic device, record the trial, hand it over",
               "tractus-station");
  app.set_version_flag("--version", TRACTUS_VERSION);
  app.footer(kExamples);
  app.require_subcommand(0, 1);
  add_data(app, options, false);
  add_server(app, options, false);
  add_run(app, options);

  CLI::App* sync = app.add_subcommand("sync", "fetch the cases that the server has");
  add_data(*sync, options, true);
  add_server(*sync, options, true);
  CLI::App* upload = app.add_subcommand("upload", "hand over the trials that wait");
  add_data(*upload, options, true);
  add_server(*upload, options, true);
  upload->add_option("--wait", options.wait_s, "s to go on trying when the server does not answer")
      ->check(CLI::Range(0.0, 1e7));
  CLI::App* trust =
      app.add_subcommand("trust", "take cases that are signed by this key from now on");
  add_data(*trust, options, true);
  auto* key =
      trust->add_option("--signer", options.signer_hex, "public key, 64 hexadecimal digits");
  auto* bundle = trust->add_option("--case", options.signer_of_case, "a case: its signer's key");
  key->excludes(bundle);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& failure) {
    out.leave = failure.get_exit_code() == 0 ? app.exit(failure) : refuse(failure.what());
    return out;
  }
  if (sync->parsed()) options.deed = Deed::sync;
  if (upload->parsed()) options.deed = Deed::upload;
  if (trust->parsed()) options.deed = Deed::trust;
  if (options.deed == Deed::trust && options.signer_hex.empty() && options.signer_of_case.empty())
    out.leave = refuse("trust: --signer or --case is expected");
  if (options.deed == Deed::run && (options.data.empty() || options.case_name.empty()))
    out.leave = refuse(options.data.empty() ? "--data is required" : "--case is required");
  return out;
}

}  // namespace app
