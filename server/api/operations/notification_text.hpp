/// What people and programs are told of an event: where to look, and no more than that.
#pragma once

#include "core/json.hpp"
#include "db/store/operations/notifications.hpp"

namespace tractus::api {

/// What a person chooses, in one line.
std::string_view meaning(store::NotificationKind kind);
/// Subject of a message: ASCII, without words that a person typed.
std::string subject_of(const std::vector<store::NotificationEvent>& events);
/// The message: a sentence and an address for each event. @param base  "https://host:8480"
core::Result<std::string> message_text(store::Reading& tx,
                                       const std::vector<store::NotificationEvent>& events,
                                       const std::string& base);
/// The body of a webhook's call: kind, time and address; no names and no titles.
core::Json webhook_json(const store::NotificationEvent& event, const std::string& base);

}  // namespace tractus::api
