/// A database with as many rows in each list as asked for.
#pragma once

#include "db/store/database/connection.hpp"

namespace tractus::bench {

/// Accounts "u0" …, of which "big" leads half of the 1000 cohorts and "small" one of them; cases, assignments with two
/// trainees and four trials each, one recorded trial and one row of the audit trail per assignment. A fifth of the
/// assignments has trials still to be done.
core::Result<void> add_rows(store::Connection& connection, int rows);

}  // namespace tractus::bench
