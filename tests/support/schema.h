// Validation of documents against the JSON Schemas that are installed.
#pragma once

#include <string>

#include <gtest/gtest.h>

namespace lobefit {

// `schema_file` counts from the repository.
testing::AssertionResult FollowsSchema(const std::string& document,
                                       const std::string& schema_file = "src/material/material.schema.json");

}  // namespace lobefit
