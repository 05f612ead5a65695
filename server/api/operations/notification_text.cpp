#include "server/api/operations/notification_text.hpp"

#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "server/api/operations/messages.hpp"

namespace tractus {
namespace api {
namespace {

using store::NotificationEvent;
using store::NotificationKind;

std::string page_of(const NotificationEvent& event) {
  switch (event.kind) {
    case NotificationKind::due:
    case NotificationKind::overdue:
    case NotificationKind::released:
      return "/assignments/" + event.subject;
    case NotificationKind::relapse:
      return "/trainees";
    case NotificationKind::self_test_failed:
      return "/network/stations/" + event.subject;
    case NotificationKind::backup_failed:
      return "/network/backups";
    case NotificationKind::test:
      return "/account/notifications";
  }
  return "/";
}

/// What is said of an event, in English. @note  {title} is the assignment's
struct EventText {
  std::string meaning, subject, sentence;
};
EventText text_of(NotificationKind kind) {
  switch (kind) {
    case NotificationKind::due:
      return {"An assignment of yours is due within a day", "Tractus: an assignment is due",
              "An assignment is due within a day: {title}."};
    case NotificationKind::overdue:
      return {"An assignment of yours, or of your cohorts, is overdue",
              "Tractus: an assignment is overdue", "An assignment is overdue: {title}."};
    case NotificationKind::released:
      return {"Results of an assignment of yours are released", "Tractus: results are released",
              "The results of an assignment are released: {title}."};
    case NotificationKind::relapse:
      return {"The results of a trainee of your cohorts signal a relapse",
              "Tractus: a relapse is signalled",
              "The results of a trainee of your cohorts signal a relapse."};
    case NotificationKind::self_test_failed:
      return {"A station failed its self-test", "Tractus: a station failed its self-test",
              "A station failed its self-test."};
    case NotificationKind::backup_failed:
      return {"A backup failed, or its verification", "Tractus: a backup failed",
              "A backup failed."};
    case NotificationKind::test:
      return {"A test", "Tractus: test message",
              "This is a test. Messages from Tractus arrive here."};
  }
  return {};
}
constexpr const char* kMany = "Tractus: {count} messages";
constexpr const char* kUntitled = "without a title";
constexpr const char* kChosen = "You chose these messages: {address}";

/// Title of the event's assignment on one line, which a person typed; empty if it is of none.
core::Result<std::string> title_of(store::Reading& tx, const NotificationEvent& event) {
  const auto rows = TRY(tx.query("select title from studies where id = ?", {event.subject}));
  return rows.empty() ? std::string() : core::one_line(rows.front().text(0), 100);
}

}  // namespace

std::string meaning(NotificationKind kind) { return text_of(kind).meaning; }

std::vector<std::string> mail_sentences() {
  std::vector<std::string> out{kMany, kUntitled, kChosen};
  for (const NotificationKind kind : core::values<NotificationKind>()) {
    const EventText text = text_of(kind);
    out.insert(out.end(), {text.subject, text.sentence});
  }
  return out;
}

std::string subject_of(const std::vector<NotificationEvent>& events, std::string_view language) {
  if (events.size() == 1) return translated(text_of(events.front().kind).subject, language);
  return filled_in(translated(kMany, language), {{"count", std::to_string(events.size())}});
}

core::Result<std::string> message_text(store::Reading& tx,
                                       const std::vector<NotificationEvent>& events,
                                       const std::string& base, std::string_view language) {
  std::string out;
  for (const NotificationEvent& event : events) {
    auto title = TRY(title_of(tx, event));
    if (title.empty()) title = translated(kUntitled, language);
    const std::string sentence = translated(text_of(event.kind).sentence, language);
    out += fmt::format("{}\r\n{}{}\r\n\r\n", filled_in(sentence, {{"title", title}}), base,
                       page_of(event));
  }
  return out +
         filled_in(translated(kChosen, language), {{"address", base + "/account/notifications"}}) +
         "\r\n";
}

core::Json webhook_json(const NotificationEvent& event, const std::string& base) {
  return {{"type", name(event.kind)},
          {"timestamp", core::utc_text(event.at_utc_us)},
          {"data",
           {{"event", event.id}, {"subject", event.subject}, {"address", base + page_of(event)}}}};
}

}  // namespace api
}  // namespace tractus
