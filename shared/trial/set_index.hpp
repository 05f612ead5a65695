/// What set.json of both rigs has in common: identity, stated facts, the list of trials.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::trial {

struct SetEntry {
  std::string id, file, operator_name, notes;
};

struct SetIndex {
  core::Json stated = core::Json::object();  ///< kStatedFields, as they stand there
  std::vector<SetEntry> entries;
};

inline constexpr std::size_t kMaxRowsOfSet = 20'000'000;

/// Reads set.json of a folder. @param rig  the one asked for. @param more  reads what a rig has of
/// its own; errors it notes on the fields are told. Errors: bad_input, not_found, each one line.
core::Result<SetIndex> read_set_index(
    const std::filesystem::path& folder, std::string_view rig,
    const std::function<core::Result<void>(core::Fields&)>& more = {});

/// set.json of those trials, without what a rig has of its own.
core::Json set_json(std::string_view rig, const core::Json& stated,
                    std::span<const SetEntry> entries);

/// What is wrong with a path that must stay within the set's folder, or nothing.
std::string leaves_folder(const std::filesystem::path& folder, const std::string& relative);

/// What is wrong with a time stamp after the ones before, or nothing.
std::string wrong_time(std::span<const double> before, double t_s);

/// Writes one file of a set that is being made, its folders included.
core::Result<void> write_set_file(const std::filesystem::path& folder, const std::string& relative,
                                  std::string_view text);

}  // namespace tractus::trial
