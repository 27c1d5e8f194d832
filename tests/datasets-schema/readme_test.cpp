#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/validate.h>

#include "support/program.h"

namespace kerf::schema {
namespace {

TEST(Readme, HoldsTheTablesThatTheCodePrints) {
  const std::string readme = test::read_text(KERF_SOURCE_DIR "/datasets-schema/README.md");
  EXPECT_NE(readme.find(schema_as_markdown()), std::string::npos)
      << "replace the tables in datasets-schema/README.md by what 'kerf info --schema' prints:\n"
      << schema_as_markdown();
}

TEST(Readme, HoldsTheTablesOfSessionsThatTheCodePrints) {
  const std::string readme = test::read_text(KERF_SOURCE_DIR "/datasets-schema/README.md");
  EXPECT_NE(readme.find(session_schema_as_markdown()), std::string::npos)
      << "replace the tables of sessions in datasets-schema/README.md by:\n"
      << session_schema_as_markdown();
}

}  // namespace
}  // namespace kerf::schema
