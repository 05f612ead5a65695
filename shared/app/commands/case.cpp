/// `tractus case`: looks at a case and says whether it is whole.
#include "cases/case.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "app/command.hpp"
#include "cases/making.hpp"
#include "core/clock.hpp"
#include "core/try.hpp"

namespace tractus {
namespace commands {
namespace {

using core::Json;

struct CaseOptions {
  std::string folder, observer;
  bool json = false;
};

/// What a part is to whoever holds the folder.
std::string state_of(const cases::OpenedCase& opened, const cases::Part& part) {
  const bool here = std::filesystem::exists(opened.folder / part.name);
  return fmt::format("{}{}", part.secret ? "secret" : "open", here ? "" : ", not here");
}

int say_broken(const CaseOptions& o, const core::Error& error) {
  if (o.json)
    std::puts(Json({{"holds", false}, {"why", error.what}}).dump(2).c_str());
  else
    fmt::print("does not hold: {}\n", error.what);
  return 1;
}

Outcome verify(const CaseOptions& o) {
  const auto opened = cases::open_case(o.folder);
  if (!opened && opened.error().code == core::Errc::corrupt) return say_broken(o, opened.error());
  if (!opened) return opened.error();
  if (o.json)
    std::puts(Json({{"holds", true}, {"case", opened->id}, {"signer", opened->signer_public_hex}})
                  .dump(2)
                  .c_str());
  else
    fmt::print("holds: {}\nsigned by {}\n", opened->id, opened->signer_public_hex);
  return 0;
}

Outcome show(const CaseOptions& o) {
  const auto opened = TRY(cases::open_case(o.folder));
  if (o.json) {
    Json out = {{"case", opened.id}, {"signer", opened.signer_public_hex}};
    out["manifest"] = opened.definition.to_json();
    std::puts(out.dump(2).c_str());
    return 0;
  }
  const auto& made = opened.definition;
  const auto& tract = made.tract;
  const math::Vec3 entry = tract.entry_m * 1e3, end = tract.end_m() * 1e3;
  fmt::print("{}\nsource  {}\nmade    {}\ncase    {}\nsigner  {}\n", made.title, made.source,
             core::utc_text(made.made_utc_us), opened.id, opened.signer_public_hex);
  fmt::print(
      "tract   ({:.1f}, {:.1f}, {:.1f}) to ({:.1f}, {:.1f}, {:.1f}) mm, {:.1f} mm long, {:.1f} mm "
      "wide\n",
      entry.x(), entry.y(), entry.z(), end.x(), end.y(), end.z(), tract.length_m * 1e3,
      tract.radius_m * 2e3);
  fmt::print("bone    {}, {}\n", volume::name(made.preparation),
             !made.certified   ? "not certified"
             : *made.certified ? "every wall's breach can be felt"
                               : "NOT every wall's breach can be felt");
  fmt::print("model   {}, {} points on {:.0f} mm\n", made.model.name, made.model.base.points,
             made.model.base.length_m * 1e3);
  for (const auto& part : made.parts)
    fmt::print("part    {:<12} {:>10} bytes  {:.12}…  {}\n", part.name, part.size_bytes,
               part.sha256, state_of(opened, part));
  return 0;
}

/// The certificate that the case was made with, or what can be said of a case that has none.
/// With an observer's file: its breach tried now, for that person.
core::Result<Json> certificate_of(const CaseOptions& o, const cases::OpenedCase& opened) {
  if (opened.definition.certified && o.observer.empty()) return cases::read_certificate(opened);
  cases::Perception perception;
  if (!o.observer.empty()) perception = TRY(cases::read_perception(o.observer));
  const auto truth = TRY(cases::read_truth(opened));
  const auto file = TRY(volume::VolumeFile::open(opened.folder / cases::kVolumePart));
  const auto drilled = TRY(file.read_all());
  return TRY(cases::certify_drilled(drilled, opened.definition, truth, perception)).to_json();
}

void print_wall(const Json& wall) {
  const auto number = [&](const char* key) {
    return wall[key].is_null() ? std::string("not known")
                               : fmt::format("{:.1f}", wall[key].get<double>());
  };
  fmt::print("{:>9}  {}  K {}, B {}, FA {}{}\n", wall["wall"].get<std::string>(),
             wall["passes"].get<bool>() ? "can be told     " : "CANNOT be told  ", number("k"),
             number("b"), number("fa"),
             wall["why_not"].is_null() ? "" : "  " + wall["why_not"].get<std::string>());
}

/// Exit status 1 where a breach cannot be told.
Outcome certify(const CaseOptions& o) {
  const auto opened = TRY(cases::open_case(o.folder));
  const auto certificate = TRY(certificate_of(o, opened));
  const bool passes = certificate["passes"].get<bool>();
  if (o.json) {
    std::puts(certificate.dump(2).c_str());
    return passes ? 0 : 1;
  }
  if (!opened.definition.certified || !o.observer.empty())
    fmt::print("its breach against the tract's other places:\n");
  for (const Json& wall : certificate["walls"]) print_wall(wall);
  return passes ? 0 : 1;
}

}  // namespace

Command case_command() {
  return {"case", "Show a case, or verify that it is unchanged since it was signed",
          "tractus case verify l3-left-medial", [](CLI::App& app) {
            auto options = std::make_shared<CaseOptions>();
            app.require_subcommand(1);
            CLI::App* check =
                app.add_subcommand("verify",
                                   "verify the signature and every part; the exit code is 0 if all "
                                   "are valid, else 1, and the first invalid part is named");
            CLI::App* look =
                app.add_subcommand("show", "show title, tract, model and parts, but not the truth");
            CLI::App* felt = app.add_subcommand(
                "certify",
                "what an ideal observer can tell of each wall by feel: the certificate that the "
                "case was made with, or its breach tried now; the exit code is 0 if every breach "
                "can be told, else 1. It shows the truth");
            for (CLI::App* each : {check, look, felt}) {
              each->add_option("DIR", options->folder, "folder of the case")->required();
              each->add_flag("--json", options->json, "print as JSON");
              each->footer("Example:\n  tractus case " + each->get_name() + " l3-left-medial");
            }
            felt->add_option("--observer", options->observer,
                             "a person's own thresholds, as tractus-station threshold wrote them: "
                             "the breach is tried now");
            return [options, check, felt] {
              return check->parsed()  ? verify(*options)
                     : felt->parsed() ? certify(*options)
                                      : show(*options);
            };
          }};
}

}  // namespace commands
}  // namespace tractus
