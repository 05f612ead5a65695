/// The parts of the report's page, top to bottom.
#pragma once

#include <string>

#include "lab/report/report.hpp"

namespace tractus::lab::page {

inline constexpr const char* kBeforeColour = "#d9731a";  ///< the model to improve
inline constexpr const char* kBetterColour = "#1b4f8f";  ///< refitted and extended
inline constexpr const char* kMeasuredColour = "#22272e";

/// The page's style sheet; recolours the inks of plot::svg in the dark.
extern const char* const kStyle;

// Each gives a <section>, or nothing where the content has nothing to show.
std::string verdict(const ReportContent& content);
std::string falling_error(const ReportContent& content);
std::string overlays(const ReportContent& content);
std::string places(const ReportContent& content);
std::string ranking(const ReportContent& content);
std::string parameters(const ReportContent& content);
std::string undecided(const ReportContent& content);
std::string distributions(const ReportContent& content);
std::string trials(const ReportContent& content);
std::string assumptions(const ReportContent& content);

/// <section> with a heading and, under it, one line of explanation.
std::string section(const std::string& title, const std::string& lead, const std::string& body);
/// A bar of `share` (0 … 1) of the cell's width; `kind` is a class of the style sheet.
std::string bar(double share, const std::string& kind);
/// The wall unrolled, darker where the error is larger.
std::string tract_picture(const TractMap& map, const std::string& unit);
/// "12 %", "0.4 %".
std::string percent(double share);
/// Figures kept on one line with their unit.
std::string unbroken(std::string text, const std::string& unit);
/// What the better model is called; not escaped.
std::string better_name(const ReportContent& content);

}  // namespace tractus::lab::page
