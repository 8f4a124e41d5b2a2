#include "tests/support/schema.h"

#include <fstream>

#include "tests/support/paths.h"
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

namespace lobefit {

testing::AssertionResult FollowsSchema(const std::string& document, const std::string& schema_file) {
  std::ifstream in(test::SourceDir() / schema_file);
  const nlohmann::json schema_json = nlohmann::json::parse(in);
  valijson::Schema schema;
  valijson::SchemaParser parser;
  const valijson::adapters::NlohmannJsonAdapter schema_adapter(schema_json);
  parser.populateSchema(schema_adapter, schema);
  const nlohmann::json target_json = nlohmann::json::parse(document);
  const valijson::adapters::NlohmannJsonAdapter target(target_json);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, target, &results)) return testing::AssertionSuccess();
  testing::AssertionResult failure = testing::AssertionFailure();
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    for (const std::string& part : error.context) failure << part;
    failure << ": " << error.description << '\n';
  }
  return failure;
}

}  // namespace lobefit
