/// What `tractus-station` does. A new one: a line here, its file, and its subcommand in
/// options.cpp.
#pragma once

#include "station/app/options.hpp"

namespace tractus::app {

/// 0: done. 1: the answer is "no" (a trial ended in a fault; trials still wait for the server).
core::Result<int> run_trials(const Options& options);
core::Result<int> run_probing_trials(const Options& options);
core::Result<int> tune_scenario(const Options& options);
core::Result<int> run_study(const Options& options);
core::Result<int> sync_cases(const Options& options);
core::Result<int> upload_trials(const Options& options);
core::Result<int> run_assigned(const Options& options);
core::Result<int> run_kiosk(const Options& options);
core::Result<int> enrol_station(const Options& options);
core::Result<int> show_limits(const Options& options);
core::Result<int> align_room(const Options& options);
core::Result<int> trust_signer(const Options& options);
core::Result<int> record_room(const Options& options);
/// `record --program`: what the rig plays by itself.
core::Result<int> play_program(const Options& options);
core::Result<int> self_test(const Options& options);
core::Result<int> calibrate(const Options& options);
core::Result<int> measure_thresholds(const Options& options);

/// From a signal handler: ends what is running in good order.
void ask_to_stop() noexcept;

}  // namespace tractus::app
