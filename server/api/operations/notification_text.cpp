#include "server/api/operations/notification_text.hpp"

#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

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

/// Title of the assignment on one line; a person typed it.
core::Result<std::string> title_of(store::Reading& tx, const std::string& study_id) {
  const auto rows = TRY(tx.query("select title from studies where id = ?", {study_id}));
  return rows.empty() || rows.front().text(0).empty() ? std::string("without a title")
                                                      : core::one_line(rows.front().text(0), 100);
}

core::Result<std::string> sentence_of(store::Reading& tx, const NotificationEvent& event) {
  switch (event.kind) {
    case NotificationKind::due: {
      const auto title = TRY(title_of(tx, event.subject));
      return fmt::format("An assignment is due within a day: {}.", title);
    }
    case NotificationKind::overdue: {
      const auto title = TRY(title_of(tx, event.subject));
      return fmt::format("An assignment is overdue: {}.", title);
    }
    case NotificationKind::released: {
      const auto title = TRY(title_of(tx, event.subject));
      return fmt::format("The results of an assignment are released: {}.", title);
    }
    case NotificationKind::relapse:
      return std::string("The results of a trainee of your cohorts signal a relapse.");
    case NotificationKind::self_test_failed:
      return std::string("A station failed its self-test.");
    case NotificationKind::backup_failed:
      return std::string("A backup failed.");
    case NotificationKind::test:
      return std::string("This is a test. Messages from Tractus arrive here.");
  }
  return std::string();
}

}  // namespace

std::string_view meaning(NotificationKind kind) {
  switch (kind) {
    case NotificationKind::due:
      return "An assignment of yours is due within a day";
    case NotificationKind::overdue:
      return "An assignment of yours, or of your cohorts, is overdue";
    case NotificationKind::released:
      return "Results of an assignment of yours are released";
    case NotificationKind::relapse:
      return "The results of a trainee of your cohorts signal a relapse";
    case NotificationKind::self_test_failed:
      return "A station failed its self-test";
    case NotificationKind::backup_failed:
      return "A backup failed, or its verification";
    case NotificationKind::test:
      return "A test";
  }
  return "";
}

std::string subject_of(const std::vector<NotificationEvent>& events) {
  if (events.size() != 1) return fmt::format("Tractus: {} messages", events.size());
  switch (events.front().kind) {
    case NotificationKind::due:
      return "Tractus: an assignment is due";
    case NotificationKind::overdue:
      return "Tractus: an assignment is overdue";
    case NotificationKind::released:
      return "Tractus: results are released";
    case NotificationKind::relapse:
      return "Tractus: a relapse is signalled";
    case NotificationKind::self_test_failed:
      return "Tractus: a station failed its self-test";
    case NotificationKind::backup_failed:
      return "Tractus: a backup failed";
    case NotificationKind::test:
      return "Tractus: test message";
  }
  return "Tractus";
}

core::Result<std::string> message_text(store::Reading& tx,
                                       const std::vector<NotificationEvent>& events,
                                       const std::string& base) {
  std::string out;
  for (const NotificationEvent& event : events) {
    const auto sentence = TRY(sentence_of(tx, event));
    out += fmt::format("{}\r\n{}{}\r\n\r\n", sentence, base, page_of(event));
  }
  return out + fmt::format("You chose these messages: {}/account/notifications\r\n", base);
}

core::Json webhook_json(const NotificationEvent& event, const std::string& base) {
  return {{"type", name(event.kind)},
          {"timestamp", core::utc_text(event.at_utc_us)},
          {"data",
           {{"event", event.id}, {"subject", event.subject}, {"address", base + page_of(event)}}}};
}

}  // namespace api
}  // namespace tractus
