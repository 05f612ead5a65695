/// Records from the rows of an answer.
#pragma once

#include <optional>
#include <vector>

#include "db/store/database/value.hpp"

namespace tractus::store {

/// The records of all rows. Errors: the answer's, or that of the first row which `from` refuses.
template <class T>
core::Result<std::vector<T>> all_of(const core::Result<Rows>& rows,
                                    core::Result<T> (*from)(const Row&)) {
  if (!rows) return rows.error();
  std::vector<T> out;
  for (const Row& row : *rows) {
    auto record = from(row);
    if (!record) return record.error();
    out.push_back(std::move(*record));
  }
  return out;
}

/// The record of the first row; nothing for no rows.
template <class T>
core::Result<std::optional<T>> one_of(const core::Result<Rows>& rows,
                                      core::Result<T> (*from)(const Row&)) {
  if (!rows) return rows.error();
  if (rows->empty()) return std::optional<T>();
  auto record = from(rows->front());
  if (!record) return record.error();
  return std::optional<T>(std::move(*record));
}

/// Success where no row is expected. Errors: the answer's.
inline core::Result<void> done(const core::Result<Rows>& rows) {
  if (!rows) return rows.error();
  return {};
}

/// Null for an empty text.
inline Value text_or_null(const std::string& text) { return text.empty() ? Value() : Value(text); }

}  // namespace tractus::store
