/// How many files and connections this process may have open.
#pragma once

namespace tractus::app {

/// Raises the soft limit of file descriptors, 1024 for a service of systemd, to the hard limit.
/// @returns the number of connections that leaves descriptors for files, the database and programs:
///          `wanted` where there are enough
int connections_within_limit(int wanted);

}  // namespace tractus::app
