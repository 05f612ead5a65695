/// What must hold when any bytes at all are read as a trial.
#pragma once

#include "core/bytes.hpp"

namespace tractus::fuzz {

/// Makes checksums, sequence numbers, magic and the hash of the end frame true, frame by frame, so
/// that a mutation reaches what lies behind them.
core::Bytes repaired(core::Bytes bytes);

/// Reads, scans and recovers `bytes` as a trial file; ends the process (core::require) when a
/// promise of trial_file.hpp is broken. Returns whether they were read.
bool try_trial(core::ByteView bytes);

}  // namespace tractus::fuzz
