/// A hospital's PACS over DICOMweb (PS3.18): what studies and series it has, and the files of one.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "server/api/volumes/series_files.hpp"

namespace tractus::api {

/// "tractus-pacs/1": {"format","base" (address of the DICOMweb service, "https://pacs/dicom-web"),
/// "token_file"? (a bearer token), "user"?,"password_file"? (files relative to the settings),
/// "authority"? (PEM file)}. No other address is ever asked.
struct PacsSettings {
  std::string base, user = {}, password = {}, token = {};
  std::filesystem::path authority = {};
  std::chrono::seconds patience{15};         ///< for a whole list
  std::chrono::seconds silence{20};          ///< within the files of a series
  std::chrono::minutes series_patience{30};  ///< for all files of a series
};
/// Errors: those of reading; bad_input naming file and field.
core::Result<PacsSettings> read_pacs_settings(const std::filesystem::path& path);

/// What studies are asked for; at least one of the first four is given.
struct StudySearch {
  std::string patient_id = {};
  std::string from = {}, to = {};  ///< days, "2024-03-14"
  std::string description = {};    ///< a part of it
  long offset = 0;
};
/// Reads a search from a request's body. Errors are noted in `fields`.
StudySearch study_search_from(core::Fields& fields);

/// Studies of a page, at most.
inline constexpr std::size_t kStudiesOfPage = 50;
/// Series of a study that are listed, at most.
inline constexpr std::size_t kMostSeries = 200;

/// What the PACS says of a study beside whose it is; an empty text or nothing where it says nothing.
struct PacsStudy {
  std::string uid, date, description;  ///< date: "2024-03-14"
  std::vector<std::string> modalities;
  std::optional<std::uint64_t> series, files;
};
struct PacsSeries {
  std::string uid, modality, description;
  std::optional<std::uint64_t> number, files;
  /// Between pixels: between rows, between columns; and the thickness of a slice.
  std::optional<double> row_spacing_m, column_spacing_m, thickness_m;
  std::optional<double> slice_spacing_m;  ///< between the middles of neighbouring slices
};

/// Digits and dots, at most 64: it becomes a part of an address.
bool is_uid(const std::string& text);

/// Errors of all: unavailable (no answer, or one that says why not: "the PACS at … answered 401:
/// check its token"), bad_input (an answer that is none), too_large, cancelled.
core::Result<std::vector<PacsStudy>> find_studies(const PacsSettings& pacs,
                                                  const StudySearch& search);
core::Result<std::vector<PacsSeries>> series_of(const PacsSettings& pacs, const std::string& study);

/// How much of a series has come.
struct FetchedSeries {
  std::size_t files = 0;
  std::uint64_t bytes = 0;
};
struct SeriesWish {
  std::string study_uid, series_uid;
  std::filesystem::path folder;  ///< empty; the files are written into it
  /// Asked every second at least.
  std::function<bool(const FetchedSeries& so_far)> may_go_on = {};
};
/// Asks for the files of a series in Explicit VR Little Endian, the standard's default.
core::Result<FetchedSeries> fetch_series(const PacsSettings& pacs, const SeriesWish& wish);

}  // namespace tractus::api
