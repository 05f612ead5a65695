/// What a ServedWorld begins with, made once and copied.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "tests/support/database/database.hpp"

namespace tractus::world {

/// Makes in a folder: `data` with the account "admin" and one published case, the tokens
/// `station-1` and `station-2`, and `case-id`.
/// @param address  of an empty PostgreSQL database; empty: SQLite
void furnish_world(const std::filesystem::path& folder, const std::string& address);

struct FurnishedWorld {
  std::filesystem::path folder;
  std::unique_ptr<test_support::TestDatabase> database;  ///< null: SQLite, in the folder
};

/// On the database that the environment asks for. On SQLite it stays in the build folder for other
/// test programs, until what makes it is built anew; on PostgreSQL it ends with this program.
const FurnishedWorld& furnished_world();

}  // namespace tractus::world
