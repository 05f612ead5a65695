/// A person's own data as one zip: what the person may see, and nothing that an assignment still holds back.
#pragma once

#include "db/store/people/accounts.hpp"
#include "server/api/backend.hpp"

namespace tractus::api {

/// The recordings of one part are at most so large together; the tables are in the first part.
inline constexpr std::uint64_t kOwnDataPart_bytes = 1ull << 30;

/// @param client  whose scratch space is used
/// @param part    from 1. Errors: not_found (no such part); unavailable (no scratch space); io; corrupt (a recording is missing).
core::Result<std::shared_ptr<http::ScratchFile>> own_data_zip(Backend& backend,
                                                              const std::string& client,
                                                              const store::Account& person,
                                                              std::int64_t part);

}  // namespace tractus::api
