#include "tests/support/schema/described.hpp"

#include <map>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

namespace tractus::test_support {
namespace {

/// The validator takes unordered JSON.
nlohmann::json unordered(const core::Json& json) {
  return nlohmann::json::parse(json.dump(-1, ' ', false, core::Json::error_handler_t::replace));
}

}  // namespace

struct Described::Parsed {
  nlohmann::json components;
  std::map<std::string, std::unique_ptr<valijson::Schema>> schemas = {};

  const valijson::Schema& schema(const std::string& name) {
    auto& found = schemas[name];
    if (found) return *found;
    found = std::make_unique<valijson::Schema>();
    const nlohmann::json root{{"$ref", "#/components/schemas/" + name}, {"components", components}};
    valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(root), *found);
    return *found;
  }
};

Described::Described(const core::Json& openapi)
    : parsed_(std::make_unique<Parsed>(Parsed{unordered(openapi.at("components"))})) {}
Described::~Described() = default;

std::string Described::deviations(const std::string& schema, const core::Json& document) {
  const nlohmann::json copy = unordered(document);
  valijson::ValidationResults results;
  valijson::Validator validator;
  validator.validate(parsed_->schema(schema), valijson::adapters::NlohmannJsonAdapter(copy),
                     &results);
  std::string out;
  for (const auto& error : results) {
    for (const std::string& step : error.context) out += step;
    out += ": " + error.description + "\n";
  }
  return out;
}

}  // namespace tractus::test_support
