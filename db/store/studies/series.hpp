/// The ids of studies and of assignments. Both are a series of trials (a row of `studies`, told
/// apart by its column `kind`), and each has an id type of its own, so that what is meant for one
/// cannot be given the other. Only looking an id up, or adding its row, makes a value of these
/// types.
#pragma once

#include "db/store/store.hpp"

namespace tractus::store {

enum class SeriesKind { study, assignment };
constexpr auto words(SeriesKind) {
  using enum SeriesKind;
  return std::to_array<core::Word<SeriesKind>>({{study, "study"}, {assignment, "assignment"}});
}

class StudyId;
class AssignmentId;

/// Errors: not_found, also for the id of an assignment.
core::Result<StudyId> find_study(Reading& tx, const std::string& id);
/// Errors: not_found, also for the id of a study.
core::Result<AssignmentId> find_assignment(Reading& tx, const std::string& id);
/// Is there a study or an assignment of this id?
core::Result<bool> series_exists(Reading& tx, const std::string& id);
/// Its title; empty where there is none of this id.
core::Result<std::string> series_title(Reading& tx, const std::string& id);

/// Either of the two. Functions that do the same to both take this one.
class SeriesId {
 public:
  const std::string& text() const { return text_; }

 protected:
  explicit SeriesId(std::string text) : text_(std::move(text)) {}

 private:
  std::string text_;
};

/// A study of research that is in the database.
class StudyId final : public SeriesId {
  using SeriesId::SeriesId;
  friend core::Result<StudyId> find_study(Reading& tx, const std::string& id);
};

/// An assignment that is in the database.
class AssignmentId final : public SeriesId {
  using SeriesId::SeriesId;
  friend core::Result<AssignmentId> find_assignment(Reading& tx, const std::string& id);
};

}  // namespace tractus::store
