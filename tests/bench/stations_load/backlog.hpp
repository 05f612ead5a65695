/// What an outage left, handed over, against a plain upload of as many bytes.
#pragma once

#include "tests/bench/stations_load/server.hpp"
#include "tests/bench/support/report.hpp"

namespace tractus::load {

/// `trials` of ten seconds at 1 kHz, by the product's own uplink; the rival sends one stream of the
/// same bytes in the largest pieces the server takes and checks nothing.
/// @param connections  trials that send their pieces at a time
void judge_backlog(bench::Report& report, const Server& server, int trials, int connections,
                   const std::filesystem::path& folder);

}  // namespace tractus::load
