/// blind-probing: a simulated measurement set of the probing rig with something hidden in it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "probing/write.hpp"

namespace {

/// What was asked for by name, checked against the lists.
bool choose(blind::Request& request, const std::string& effect,
            const std::vector<std::string>& pair, const std::string& outside,
            const std::string& kind) {
  const auto in = [](const std::vector<std::string>& list, const std::string& id) {
    return std::ranges::find(list, id) != list.end();
  };
  if (!effect.empty()) request.kind = "single", request.ids = {effect};
  if (!pair.empty()) request.kind = "pair", request.ids = pair;
  if (!outside.empty()) request.kind = "outside", request.ids = {outside};
  if (!kind.empty()) request.kind = kind;
  const auto& list = request.kind == "outside" ? blind::outside_kinds() : blind::catalogue();
  for (const std::string& id : request.ids) {
    if (in(list, id)) continue;
    std::fprintf(stderr, "blind-probing: '%s' is not an effect this generator has\n", id.c_str());
    return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "A simulated probing set with a hidden effect.\nExample: blind-probing --seed 7 --out "
      "/tmp/set7");
  blind::Request request;
  std::string out, truth, effect, outside;
  std::vector<std::string> pair;
  bool none = false, base_wrong = false;
  app.add_option("--seed", request.seed, "everything not asked for is drawn from it")->required();
  app.add_option("--out", out, "folder for model.json and measurements/")->required();
  app.add_option("--truth", truth, "what was hidden (default: OUT.truth.json)");
  auto* what =
      app.add_option_group("what is hidden (default: drawn from the seed)")->require_option(0, 1);
  what->add_option("--effect", effect, "one effect of the catalogue");
  what->add_option("--pair", pair, "two effects")->expected(2);
  what->add_option("--outside", outside, "something the catalogue does not have");
  what->add_flag("--none", none, "nothing");
  what->add_flag("--base-wrong", base_wrong,
                 "nothing, and the supplied numbers off by up to a half");
  app.add_option("--trials", request.trials)->check(CLI::Range(1, 1000));
  app.add_option("--duration", request.duration_s, "s per trial")->check(CLI::Range(1.0, 600.0));
  app.add_option("--rate", request.rate_Hz, "Hz")->check(CLI::Range(10.0, 20000.0));
  CLI11_PARSE(app, argc, argv);
  if (!choose(request, effect, pair, outside, none ? "none" : base_wrong ? "base_wrong" : ""))
    return 2;
  const blind::GeneratedSet set = blind::generate(request);
  if (truth.empty()) truth = out + ".truth.json";
  if (blind::write_set(set, out) && blind::write_truth(set, truth)) return 0;
  std::fprintf(stderr, "blind-probing: cannot write %s or %s\n", out.c_str(), truth.c_str());
  return 2;
}
