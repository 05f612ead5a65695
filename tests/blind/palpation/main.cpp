/// blind-palpation: a simulated measurement set of a palpation with something hidden in it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "palpation/write.hpp"

namespace {

/// What was asked for by name, checked against the lists.
bool choose(blind::PalpationRequest& request, const std::string& effect,
            const std::vector<std::string>& pair, const std::string& outside,
            const std::string& kind) {
  if (!effect.empty()) request.kind = "single", request.ids = {effect};
  if (!pair.empty()) request.kind = "pair", request.ids = pair;
  if (!outside.empty()) request.kind = "outside", request.ids = {outside};
  if (!kind.empty()) request.kind = kind;
  const auto& list =
      request.kind == "outside" ? blind::palpation_outside() : blind::palpation_catalogue();
  for (const std::string& id : request.ids) {
    if (std::ranges::find(list, id) != list.end()) continue;
    std::fprintf(stderr, "blind-palpation: '%s' is not an effect this generator has\n", id.c_str());
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "A simulated palpation set with a hidden effect.\nExample: blind-palpation --seed 7 --out "
      "/tmp/set7");
  blind::PalpationRequest request;
  std::string out, truth, effect, outside, ct = BLIND_CT;
  std::vector<std::string> pair;
  bool none = false, base_wrong = false;
  app.add_option("--seed", request.seed, "everything not asked for is drawn from it")->required();
  app.add_option("--out", out, "folder for volume.nrrd, model.json and measurements/")->required();
  app.add_option("--truth", truth, "what was hidden (default: OUT.truth.json)");
  app.add_option("--ct", ct, "real scan that some seeds carve their tract into (NIfTI, gzip)");
  auto* what =
      app.add_option_group("what is hidden (default: drawn from the seed)")->require_option(0, 1);
  what->add_option("--effect", effect, "one effect of the catalogue");
  what->add_option("--pair", pair, "two effects")->expected(2);
  what->add_option("--outside", outside, "something the catalogue does not have");
  what->add_flag("--none", none, "nothing");
  what->add_flag("--base-wrong", base_wrong, "nothing, and the supplied numbers far off");
  app.add_option("--trials", request.trials)->check(CLI::Range(1, 1000));
  app.add_option("--duration", request.duration_s, "s per trial")->check(CLI::Range(1.0, 600.0));
  app.add_flag("--tract", request.states_tract, "let set.json state where the channel is");
  app.add_option("--rate", request.rate_Hz, "Hz")->check(CLI::Range(20.0, 4000.0));
  CLI11_PARSE(app, argc, argv);
  if (!choose(request, effect, pair, outside, none ? "none" : base_wrong ? "base_wrong" : ""))
    return 2;
  request.ct = ct;
  const blind::PalpationSet set = blind::generate_palpation(request);
  if (truth.empty()) truth = out + ".truth.json";
  if (blind::write_set(set, out) && blind::write_truth(set, truth)) return 0;
  std::fprintf(stderr, "blind-palpation: cannot write %s or %s\n", out.c_str(), truth.c_str());
  return 2;
}
