/// Does a document keep to a schema of the API's description? Judged by a validator that others
/// wrote (valijson, JSON Schema draft 7).
#pragma once

#include <memory>
#include <string>

#include "core/json.hpp"

namespace tractus::test_support {

class Described {
 public:
  /// @param openapi  whole, with components/schemas.
  explicit Described(const core::Json& openapi);
  ~Described();

  /// Where and how the document deviates from the schema, one line each; empty if it does not.
  std::string deviations(const std::string& schema, const core::Json& document);

 private:
  struct Parsed;
  std::unique_ptr<Parsed> parsed_;
};

}  // namespace tractus::test_support
