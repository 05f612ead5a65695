/// Conditions on a table's rows: "operation_time_s > 300 and scenario = soft".
#pragma once

#include <string>
#include <vector>

#include "assessment/table.hpp"

namespace tractus::assessment {

/// COLUMN OP VALUE, joined by "and". OP: = != < <= > >=, the last four for numbers alone. A row
/// whose cell is empty meets no condition but `COLUMN = missing`.
class Filter {
 public:
  /// Errors: bad_input naming the part that cannot be read.
  static core::Result<Filter> parse(const std::string& text);

  const std::vector<std::string>& columns() const { return columns_; }
  /// Per row: does it meet every condition? Errors: bad_input for a column that is not there, or
  /// FILE:LINE of a cell that should be a number.
  core::Result<std::vector<bool>> rows_of(const Table& table) const;

 private:
  struct Condition {
    std::string column, op, value;
    std::optional<double> number;
  };
  std::vector<Condition> conditions_;
  std::vector<std::string> columns_;
};

}  // namespace tractus::assessment
