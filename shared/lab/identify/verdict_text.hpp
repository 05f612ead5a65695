/// The lab's answers in plain words, for the terminal and the report.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "lab/identify/diagnosis.hpp"

namespace tractus::lab {

/// A name that ends in its unit, taken apart: "friction_N" → friction, N; "mass_kg" → mass, kg;
/// without a unit, the name alone.
struct NameAndUnit {
  std::string name, unit;
};
NameAndUnit name_and_unit(std::string_view name);

/// Three significant digits: "2.31".
std::string figure(double value);
/// As many digits as an uncertainty of `within` leaves of meaning, two of it: 2.29993 within 0.0006
/// is "2.29993", within 0.06 "2.300".
std::string figure_with_uncertainty(double value, double within);
/// With its unit: "1.07 N".
std::string figure(double value, std::string_view unit);

/// The verdict as a headline ("Coulomb friction is missing.") and a sentence with the figures.
struct VerdictText {
  std::string headline, detail;
};
VerdictText sentences(const Diagnosis& diagnosis, std::string_view unit);

/// "friction 0.052 N", "stiffness: not within its range".
std::string text_of(const DetectionLimit& limit);

}  // namespace tractus::lab
