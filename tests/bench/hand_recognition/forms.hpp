/// A pedicle's case in all its forms: whole, and with the breach of each wall that the certificate
/// speaks of. Made once, kept in a folder if one is given.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "bench/feelability/pedicles.hpp"

namespace tractus::bench {

/// One truth of a case, with what the certificate says of it.
struct Form {
  std::optional<volume::Wall> breach;  ///< none: whole
  double d_prime = 0.0;                ///< of the breach; 0 of a whole one
  bool passes = true;                  ///< the certificate's limits; a whole one always does
  cases::Carved carved;                ///< tract and volume; the rest may be empty
};

/// How a case is told: "L3 left, filled".
std::string name_of(const Pedicle& pedicle, volume::Preparation preparation);

models::PalpationModel published_model();

/// Errors: those of cases::make and cases::carve; io, of the folder.
/// @param keep  where forms are kept and taken from; empty: nowhere
core::Result<std::vector<Form>> forms_of(const Pedicle& pedicle, volume::Preparation preparation,
                                         const std::filesystem::path& keep);

}  // namespace tractus::bench
