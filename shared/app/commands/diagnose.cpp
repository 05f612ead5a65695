/// `tractus diagnose`: which effect is missing from a model.
#include <fmt/format.h>

#include <memory>

#include "app/command.hpp"
#include "app/lab_report.hpp"
#include "core/json.hpp"
#include "core/progress.hpp"
#include "core/try.hpp"
#include "lab/discover/table_effect.hpp"

namespace tractus {
namespace commands {
namespace {

constexpr std::size_t kProposals = 5;  // written where their number is not given

struct DiagnoseOptions : LabOptions {
  std::filesystem::path out_model, proposals, next_recording;
  std::size_t propose = 0;
};

/// One file for each term that is proposed, ready for --effect.
core::Result<void> write_proposals(const lab_io::LabResult& answer,
                                   const std::filesystem::path& folder) {
  if (folder.empty() || !answer.discovery) return {};
  for (const lab::Proposal& proposal : answer.discovery->proposals)
    for (const lab::ProposedTerm& term : proposal.terms) {
      const auto id = term.effect["id"].get<std::string>();
      TRY(core::write_json(folder / (id.substr(id.find(':') + 1) + ".json"), term.effect));
    }
  if (answer.discovery->unknown)
    if (const auto table =
            lab::table_effect(*answer.discovery->unknown, "expression:unknown_function"))
      TRY(core::write_json(folder / "unknown_function.json", *table));
  return {};
}

Outcome run_diagnose(const DiagnoseOptions& options) {
  for (const auto& file : {options.report, options.out_model, options.next_recording})
    TRY(writable(file));
  if (!options.proposals.empty() && !std::filesystem::is_directory(options.proposals))
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: there is no such folder", options.proposals.string())};
  const auto opened_case = TRY(opened(options));
  lab_io::DiagnoseRequest wish{
      .options = {}, .report = !options.report.empty(), .propose = options.propose};
  if (!options.proposals.empty() && wish.propose == 0) wish.propose = kProposals;
  wish.options.threads = options.sources.threads;
  if (options.sources.keep_recordings) wish.programs = lab_io::DiagnoseRequest::Weigh::always;
  const auto bar = core::terminal_progress("trying effects");
  const auto answer = TRY(lab_io::diagnosed(opened_case, wish, bar));
  if (bar) bar(1.0);
  TRY(write_files(answer, options.out_model, options.report));
  TRY(write_proposals(answer, options.proposals));
  if (!options.next_recording.empty() && !answer.programs.empty())
    TRY(core::write_json(options.next_recording, answer.programs.front().program.to_json()));
  fmt::print("{}", options.json ? answer.json.dump(2) + "\n" : printed_diagnosis(answer));
  return 0;
}

}  // namespace

Command diagnose_command() {
  return {.name = "diagnose",
          .summary = "Find the physical effects that a model lacks",
          .example =
              "tractus diagnose --model bone.model.json --measurements recordings/ "
              "--out-model better.model.json --report found.html",
          .make = [](CLI::App& app) -> std::function<Outcome()> {
            auto options = std::make_shared<DiagnoseOptions>();
            add_lab_options(app, *options);
            add_own_option(app, *options);
            app.add_option("--out-model", options->out_model,
                           "file for the refitted model with the effects that were found");
            app.add_option("--propose", options->propose,
                           "also search for formulas that explain what no effect of the catalogue "
                           "does, and propose so many at most")
                ->check(CLI::Range(1, 20));
            app.add_option(
                "--write-proposals", options->proposals,
                "folder for the proposed formulas as user effects (tractus-effect/1), "
                "proposal_1.json and so on, to be added with --effect; unknown_function.json is "
                "the best function without a formula, as a table");
            app.add_option(
                   "--next-recording", options->next_recording,
                   "where more than one explanation is left: simulate what further recordings "
                   "would tell, and write the one that decides most per minute as a program "
                   "(tractus-program/1) for tractus-station record --program; probing rig")
                ->each([options](const std::string&) { options->sources.keep_recordings = true; });
            return [options] { return run_diagnose(*options); };
          }};
}

}  // namespace commands
}  // namespace tractus
