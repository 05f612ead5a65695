/// One statistical method that a person may ask for on a table. One file each in methods/.
///
/// The same list is `tractus stats METHOD`, the "method" of a plan's analyses, and what a server's
/// job runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "assessment/formula.hpp"
#include "core/json.hpp"
#include "core/progress.hpp"
#include "plot/figure.hpp"

namespace tractus {
namespace assessment {

/// Something a method may be told beside its formula.
struct Option {
  std::string name;      ///< "threshold"; --threshold on the command line
  std::string meaning;   ///< one line
  std::string fallback;  ///< what holds when nothing is said; may be empty
  /// The words it may be; empty: a finite number from `low` to `high`, or for `text` anything.
  std::vector<std::string> choices;
  double low = 0.0, high = 0.0;
  bool text = false;
};

/// What a method is run on.
struct Analysis {
  const Formula& formula;
  const Table& table;
  std::string formula_text;
  std::map<std::string, std::string> options;  ///< as complete() leaves them
  core::Progress progress = {};                ///< of methods that may take minutes

  double number(const std::string& option) const;
  const std::string& text(const std::string& option) const;
  bool given(const std::string& option) const { return !text(option).empty(); }
};

/// What came out. `report` has members "method", "file", "formula", "rows", "rows_left_out", then
/// blocks (objects of numbers), tables (arrays of objects), "tests" (what may be held against an α,
/// see report.hpp), "checks" (of assumptions) and "notes" (sentences). Numbers that do not exist
/// are null.
struct Findings {
  core::Json report;
  std::vector<plot::Figure> figures;
};

struct Method {
  std::string id;       ///< "rm-anova"
  std::string summary;  ///< one line
  std::string formula;  ///< an example; empty for a method that needs no data
  std::string cites;    ///< for a methods paragraph: what it is and after whom
  std::vector<Option> options;
  core::Result<Findings> (*run)(const Analysis& of);
  bool random_terms = false;  ///< takes formulas with any random terms, not (1|group) alone
};

namespace methods {
/// Every method, in file-name order.
std::vector<Method> all();
}  // namespace methods

/// Errors: not_found naming those there are.
core::Result<Method> method_named(const std::string& id);

/// `given` with every option of `method`, each checked. Errors: bad_input naming an unknown option,
/// a word that is no choice, a number out of its range.
core::Result<std::map<std::string, std::string>> complete(
    const Method& method, const std::map<std::string, std::string>& given);

/// Reads the formula, selects its columns from `table` and runs. Errors: as the parts, one line;
/// cancelled where `progress` asked to stop.
core::Result<Findings> run(const Method& method, const Table& table, const std::string& formula,
                           const std::map<std::string, std::string>& options, Missing missing,
                           const core::Progress& progress = {});
/// The same for a method that needs no data.
core::Result<Findings> run(const Method& method, const std::map<std::string, std::string>& options,
                           const core::Progress& progress = {});

}  // namespace assessment
}  // namespace tractus
