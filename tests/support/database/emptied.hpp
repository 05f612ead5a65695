/// PostgreSQL's databases of the tests, used again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "db/store/database/connection.hpp"

namespace tractus::test_support {

/// Databases whose schema is up to date. What a test has left in one is taken away for the next,
/// which costs less than a new one and the caches that its first sessions fill. One whose schema a
/// test has changed is not used again.
class EmptiedDatabases {
 public:
  std::string take();
  void give_back(const std::string& name);

 private:
  struct Free {
    std::string name;
    int uses = 0;
    std::unique_ptr<store::Connection> connection = nullptr;
  };
  static bool empty(Free& left);
  const std::string& model();
  std::string model_;  ///< the database that others are copied from
  std::vector<Free> lent_, free_;
};

}  // namespace tractus::test_support
