/// What people and programs are told of an event: where to look, and no more than that.
#pragma once

#include "core/json.hpp"
#include "db/store/operations/notifications.hpp"

namespace tractus::api {

/// What a person chooses, in one line.
std::string meaning(store::NotificationKind kind);
/// The English sentences of e-mails; their translations: server/api/operations/messages.
std::vector<std::string> mail_sentences();
/// Subject of a message, without words that a person typed. @param language  "de"; English where
/// there is no catalogue of it
std::string subject_of(const std::vector<store::NotificationEvent>& events,
                       std::string_view language);
/// The message: a sentence and an address for each event. @param base  "https://host:8480"
core::Result<std::string> message_text(store::Reading& tx,
                                       const std::vector<store::NotificationEvent>& events,
                                       const std::string& base, std::string_view language);
/// The body of a webhook's call: kind, time and address; no names and no titles.
core::Json webhook_json(const store::NotificationEvent& event, const std::string& base);

}  // namespace tractus::api
