/// A rubric by which people rate a trial: items, each with a scale of whole points whose ends and
/// middle are described in words, as the global rating scale of OSATS has seven of 1 to 5
/// [Martin1997].
#pragma once

#include <span>
#include <vector>

#include "core/json.hpp"

namespace tractus::assessment {

struct RubricItem {
  std::string label;             ///< "Respect for tissue"
  std::string text = {};         ///< what is looked at; may be empty
  int low = 1, high = 5;         ///< ends of the scale, 0 to 10
  std::string low_text;          ///< describes the low end
  std::string middle_text = {};  ///< describes the middle; may be empty
  std::string high_text;         ///< describes the high end
};

struct Rubric {
  std::string title;
  std::vector<RubricItem> items;  ///< 1 to 30

  /// {"format": "tractus-rubric/1", "title", "items": [{"label", "text", "low", "high", "low_text",
  /// "middle_text", "high_text"}]}. Errors: bad_input with the field.
  static core::Result<Rubric> from_json(const core::Json& json, const std::string& where);
  core::Json to_json() const;
  /// Errors: bad_input unless there is one score for each item, on its scale.
  core::Result<void> check(std::span<const int> scores, const std::string& where) const;
};

}  // namespace tractus::assessment
