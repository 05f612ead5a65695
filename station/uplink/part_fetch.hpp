/// One part of a case, from the server and from what is here already, into a file that is whole or
/// goes on where it was cut.
#pragma once

#include "cases/case.hpp"
#include "station/uplink/brick_plan.hpp"
#include "station/uplink/server.hpp"

namespace tractus::uplink {

/// Appends to `target` what it lacks, in pieces; a target that a cut left is gone on with. At the
/// end it is on the disk and its SHA-256 is the part's: one that was gone on with, or put together
/// from pieces that were here, and does not hold is fetched once more from the start. Errors: the
/// server's, io (a full disk too; what is there stays), corrupt (the server's bytes are not what
/// the manifest names; nothing stays).
/// @param fetched_bytes  counts what came over the line
core::Result<void> fetch_part(Server& server, const std::string& case_id, const cases::Part& part,
                              const LocalParts& local, const std::filesystem::path& target,
                              std::uint64_t& fetched_bytes);

/// What a server sent for a case is not what was announced.
core::Error case_changed(const std::string& case_id, const std::string& what);

}  // namespace tractus::uplink
