/// What the benches of stations need to start programs and to watch them.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::load {

inline constexpr const char* kPassword = "a password of a bench";

struct Child {
  pid_t pid = -1;
  int output = -1;  ///< what it prints
};
/// A program with its arguments; what it says on standard error goes to the end of `log`.
Child spawn(const std::vector<std::string>& words, const std::filesystem::path& log);
/// The words that start `tractus-server` with these arguments.
std::vector<std::string> server_words(const std::vector<std::string>& arguments);
/// Runs `tractus-server` to its end. Did it succeed?
bool run(const std::vector<std::string>& arguments, const std::filesystem::path& log);
/// Waits until a server says where it listens: "https://host:port"; empty when it ended before.
std::string listening_url(const Child& child);

std::string first_line(const std::filesystem::path& path);
/// A small case in a new folder; its id.
core::Result<std::string> make_case(const std::filesystem::path& folder);
core::Error failed(const std::string& what, const std::filesystem::path& log);
/// Signs the admin in (kPassword); the cookie as the header Cookie has it.
core::Result<std::string> sign_in(const std::string& server,
                                  const std::filesystem::path& authority);

/// Resident memory, bytes, and processor time so far, s; 0 for a process that is gone.
double resident_bytes(pid_t pid);
double processor_s(pid_t pid);

}  // namespace tractus::load
