/// A call as the audit trail notes it.
#pragma once

#include "db/store/operations/audit.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

/// Who, what, of which object, with which words. Of a JSON body of up to 16 KiB the fields that are
/// known never to hold a secret (acts.cpp has the list) and the names of the others; of any other
/// body its size and SHA-256.
store::AuditedAction audited_action(const RouteInfo& route, const Call& call,
                                    const std::map<std::string, std::string>& segments);

/// "id=…": what a path's placeholders stand for, shortened.
std::string object_text(const std::map<std::string, std::string>& segments);

}  // namespace tractus::api
