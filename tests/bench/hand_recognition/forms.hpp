/// A pedicle's case in all its forms: whole, and with breaches of each wall that the certificate
/// speaks of. Made once, kept in a folder if one is given.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "bench/feelability/pedicles.hpp"

namespace tractus::bench {

/// One truth of a case, with what its certificate says of it.
struct Form {
  std::optional<volume::Wall> breach;  ///< none: whole
  double at_m = 0.0;                   ///< depth of the breach along the tract
  /// Where the maker would put it; else where a breach of this wall is told worst.
  bool chosen = true;
  bool passes = true;    ///< the certificate's limits; a whole one always does
  double from_m = 0.0;   ///< depth of the first place that the certificate speaks of
  cases::Carved carved;  ///< tract and volume; the rest may be empty
};

/// How a case is told: "L3 left, filled".
std::string name_of(const Pedicle& pedicle, volume::Preparation preparation);

models::PalpationModel published_model();

/// The whole one first. Filled tracts may be moved by 2 mm, as the maker does.
/// Errors: those of cases::make and cases::carve; io, of the folder.
/// @param keep  where forms are kept and taken from; empty: nowhere
core::Result<std::vector<Form>> forms_of(const Pedicle& pedicle, volume::Preparation preparation,
                                         const std::filesystem::path& keep);

}  // namespace tractus::bench
