/// All rows from one database into another of the same schema: from SQLite to PostgreSQL when one
/// machine is not enough any more, and back for a backup that needs no server.
#pragma once

#include "db/store/store.hpp"

namespace tractus::store {

/// Every table's rows, in bounded memory. Returns how many. Errors: conflict when the databases
/// have not the same tables and columns, or `to` holds something; those of the databases.
core::Result<std::uint64_t> copy_rows(Reading& from, Writing& to);

/// For the drivers: what a query for (table, column), in order, says of the tables.
core::Result<std::vector<Table>> tables_from(Connection& connection, std::string_view sql);

}  // namespace tractus::store
