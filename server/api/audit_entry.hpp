/// The entry of a call in the audit trail.
#pragma once

#include "db/store/operations/audit.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// The caller, the action, its object and its details. From a JSON body of up to 16 KiB the details
/// contain the values of fields that never contain a secret (listed in audit_entry.cpp) and the
/// names of all other fields; from any other body its size and SHA-256.
store::AuditedAction audited_action(const RouteInfo& route, const Call& call,
                                    const std::map<std::string, std::string>& segments);

/// "id=…": the values of the path's placeholders, shortened.
std::string object_text(const std::map<std::string, std::string>& segments);

}  // namespace tractus::api
