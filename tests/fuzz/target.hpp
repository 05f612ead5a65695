/// A parser that meets bytes nobody meant, as data: both drivers go by it.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/require.hpp"
#include "core/result.hpp"

namespace tractus::fuzz {

struct Target {
  std::string name;                ///< of its file, and of its folder under corpora/
  std::string faces;               ///< what the bytes are, and from whom
  std::vector<std::string> seeds;  ///< files of the repository to begin with, beside corpora/NAME
  /// Ends the process (core::require) when a promise is broken. Returns whether they were taken.
  bool (*run)(core::ByteView bytes);
  int tries = 3000;  ///< mutations that the test makes
};

/// Every file's of targets/, in file-name order.
std::vector<Target> all();
/// The contents of a target's seeds and of corpora/NAME.
std::vector<core::Bytes> seeds_of(const Target& target);

/// A refusal is one bearable line; was it taken?
template <class T>
bool taken(const core::Result<T>& result) {
  if (result) return true;
  const std::string& line = result.error().what;
  if (line.empty() || line.size() >= 2000 || line.find('\n') != std::string::npos)
    std::fprintf(stderr, "message: %.*s\n", 300, line.c_str());
  core::require(!line.empty() && line.size() < 2000, "a message is one bearable line");
  core::require(line.find('\n') == std::string::npos, "a message is one line");
  return false;
}

/// The bytes as JSON handed to `read`, when they are JSON.
template <class Read>
bool taken_json(core::ByteView bytes, Read&& read) {
  const auto json = core::parse_json(core::text_of(bytes), "it");
  return taken(json) && taken(read(*json));
}

/// A folder in memory that lasts as long as the process.
const std::filesystem::path& scratch();
/// Writes a file there and returns its path.
std::filesystem::path placed(const std::string& name, core::ByteView bytes);

}  // namespace tractus::fuzz
