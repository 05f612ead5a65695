/// Whether everything that was acknowledged is there, byte for byte.
#pragma once

#include <vector>

#include "tests/bench/stations_load/many/station.hpp"

namespace tractus::many {

struct Checked {
  std::uint64_t missing = 0;     ///< acknowledged trials that the records do not have
  std::uint64_t different = 0;   ///< whose file is not, byte for byte, what the station sent
  std::uint64_t unlisted = 0;    ///< that the server does not list with all samples
  std::uint64_t unfinished = 0;  ///< uploads that are announced and not complete
  std::uint64_t jobs_waiting = 0;
  bool verified = false;  ///< `tractus-server verify`
};

/// Reads every acknowledged trial in the data folder and compares size and SHA-256 with what its
/// station sent; asks the servers for their list of trials; runs `tractus-server verify`.
core::Result<Checked> check(const Setup& setup, const std::vector<Committed>& trials);

}  // namespace tractus::many
