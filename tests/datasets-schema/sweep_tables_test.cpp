#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/sweep_tables_file.h>

#include "datasets-schema/recording/sample_recording.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SweepTables : public testing::Test {
 protected:
  void write(std::uint64_t rows) const {
    SweepTablesWriter writer(file_);
    writer.describe("plan", R"({"verb":"fit"})");
    writer.add_values("law", {"kelvin", "maxwell"});
    const std::size_t table = writer.add_table("walls", rows,
                                               {{.name = "cell", .type = SweepColumn::Type::whole},
                                                {.name = "law", .type = SweepColumn::Type::code},
                                                {.name = "error", .unit = "N"}});
    for (std::uint64_t row = 0; row < rows; ++row) {
      const std::vector<double> values{static_cast<double>(2 * row), static_cast<double>(row % 2),
                                       row == 1 ? std::numeric_limits<double>::quiet_NaN() : 0.5};
      for (std::size_t column = 0; column < values.size(); ++column)
        writer.append(table, column, {&values[column], 1});
    }
    writer.commit(Existing::keep);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "sweep.h5";
};

TEST_F(SweepTables, AreReadAsTheyWereWritten) {
  write(3);
  const SweepTablesFile read(file_);
  EXPECT_EQ(read.facts().note("plan"), R"({"verb":"fit"})");
  EXPECT_EQ(read.facts().note("colour"), std::nullopt);
  ASSERT_EQ(read.facts().texts.size(), 1U);
  EXPECT_EQ(read.facts().texts[0].input, "law");
  EXPECT_THAT(read.facts().texts[0].texts, ElementsAre("kelvin", "maxwell"));
  ASSERT_EQ(read.facts().tables.size(), 1U);
  const SweepTable& table = read.facts().tables[0];
  EXPECT_EQ(table.name, "walls");
  EXPECT_EQ(table.rows, 3U);
  ASSERT_EQ(table.columns.size(), 3U);
  EXPECT_EQ(table.columns[1].name, "law");
  EXPECT_EQ(table.columns[1].type, SweepColumn::Type::code);
  EXPECT_EQ(table.columns[2].unit, "N");
  EXPECT_THAT(read.column(0, 0), ElementsAre(0.0, 2.0, 4.0));
  EXPECT_THAT(read.column(0, 1), ElementsAre(0.0, 1.0, 0.0));
  EXPECT_THAT(read.column(0, 2), ElementsAre(0.5, testing::IsNan(), 0.5));
}

TEST_F(SweepTables, MayHaveNoRow) {
  write(0);
  const SweepTablesFile read(file_);
  EXPECT_EQ(read.facts().tables.at(0).rows, 0U);
  EXPECT_TRUE(read.column(0, 2).empty());
}

TEST_F(SweepTables, AreToldFromOtherFiles) {
  write_recording(file_, test::sample_recording());
  try {
    const SweepTablesFile read(file_);
    ADD_FAILURE() << "a recording was taken for a sweep";
  } catch (const FormatError& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected a sweep that was merged ('kerf.sweep')"));
  }
}

}  // namespace
}  // namespace kerf::schema
