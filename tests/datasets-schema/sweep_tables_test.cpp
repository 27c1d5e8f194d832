#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/sweep_tables_file.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/changed_file.h"
#include "datasets-schema/sample_sweep.h"

namespace kerf::schema {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

class SweepTables : public testing::Test {
 protected:
  SweepTables() { test::write_sample_sweep(file_); }

  void change(const std::function<void(hid_t)>& hand) const {
    auto file = h5::WritableFile::open(file_);
    hand(file.id());
    file.close();
  }
  [[nodiscard]] std::vector<std::string> violations() const {
    std::vector<std::string> lines;
    for (const auto& [where, found, expected] : validate(file_))
      lines.push_back(where + ": " + found + ", expected " + expected);
    return lines;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "sweep.h5";
};

TEST_F(SweepTables, SayWhatIsInThem) {
  EXPECT_EQ(schema_of(file_), "kerf.sweep");
  EXPECT_THAT(violations(), IsEmpty());
  const SweepTablesFile read(file_);
  const SweepTablesFacts& facts = read.facts();
  EXPECT_EQ(facts.plan_sha256, "12ab");
  EXPECT_EQ(facts.cells, "4 computed, 1 failed, 0 missing");
  EXPECT_EQ(facts.software, "kerf 0.1.0");
  ASSERT_EQ(facts.tables.size(), 2U);
  EXPECT_EQ(facts.tables[0].name, "kelvin");
  EXPECT_EQ(facts.tables[0].rows, 3U);
  ASSERT_EQ(facts.tables[0].columns.size(), 3U);
  EXPECT_EQ(facts.tables[0].columns[1].type, SweepColumn::Type::code);
  EXPECT_EQ(facts.tables[0].columns[2].unit, "N/m");
  ASSERT_EQ(facts.texts.size(), 1U);
  EXPECT_EQ(facts.texts[0].input, "recording");
  EXPECT_THAT(facts.texts[0].texts, ElementsAre("a.h5", "b.h5"));
  EXPECT_THAT(read.column(0, 0), ElementsAre(0.0, 1.0, 4.0));
  EXPECT_THAT(read.column(0, 1), ElementsAre(0.0, 0.0, 1.0));
  EXPECT_THAT(read.column(0, 2), ElementsAre(300.0, 301.5, 299.0));
}

TEST_F(SweepTables, MayHaveNoRowAndUnknownNumbers) {
  SweepTablesWriter writer(file_);
  for (const char* const name : {"plan_sha256", "plan", "software", "cells"}) writer.describe(name, "{}");
  writer.add_values("law", {});
  const auto none = writer.add_table("none", 0, {{.name = "cell", .type = SweepColumn::Type::whole}});
  const auto one =
      writer.add_table("one", 1, {{.name = "cell", .type = SweepColumn::Type::whole}, {.name = "error"}});
  writer.append(one, 0, std::array{7.0});
  writer.append(one, 1, std::array{std::numeric_limits<double>::quiet_NaN()});
  writer.commit(Existing::replace);
  const SweepTablesFile read(file_);
  EXPECT_TRUE(read.column(none, 0).empty());
  EXPECT_THAT(read.column(one, 1), ElementsAre(testing::IsNan()));
}

TEST_F(SweepTables, AreNoneWithoutWhatTheyNeed) {
  for (const char* const name : {"plan_sha256", "plan", "software", "cells"}) {
    test::write_sample_sweep(file_);
    change([&](hid_t file) { test::remove_attribute(file, "/", name); });
    EXPECT_THAT(violations(), ElementsAre(HasSubstr("/ attribute '" + std::string(name) + "': nothing")));
    EXPECT_THROW(SweepTablesFile{file_}, FormatError);
  }
  test::write_sample_sweep(file_);
  change([](hid_t file) { test::remove_link(file, "/kelvin/cell"); });
  EXPECT_THAT(violations(), ElementsAre("/kelvin: no column 'cell', expected the number of each row's cell"));
  test::write_sample_sweep(file_);
  change([](hid_t file) { test::remove_link(file, "/values/recording"); });
  EXPECT_THAT(violations(),
              ElementsAre(HasSubstr("/kelvin/recording: places in /values/recording, which is not")));
  test::write_sample_sweep(file_);
  change([](hid_t file) { test::set_number(file, "/", "schema_version", std::uint32_t{2}); });
  EXPECT_THAT(violations(), ElementsAre("/ attribute 'schema_version': 2, expected 1"));
}

TEST_F(SweepTables, HaveColumnsOfOneLengthAndOfThreeTypes) {
  change([](hid_t file) {
    test::replace_dataset<double>(file, "/kelvin/stiffness", {2});
    test::set_text(file, "/kelvin/stiffness", "units", "N/m");
  });
  EXPECT_THAT(violations(), ElementsAre("/kelvin/stiffness: 2 rows, expected 3, as the column before"));
  change([](hid_t file) { test::replace_dataset<float>(file, "/kelvin/stiffness", {3}); });
  EXPECT_THAT(violations(),
              ElementsAre(HasSubstr("/kelvin/stiffness: float32, expected float64, uint64 or")));
  EXPECT_THAT([&] { const SweepTablesFile read(file_); },
              ThrowsMessage<FormatError>(HasSubstr("/kelvin/stiffness: found float32, expected")));
}

TEST_F(SweepTables, HaveEachCellOnceInOrderAndCodesOfTexts) {
  change([](hid_t file) { test::set_values<std::uint64_t>(file, "/kelvin/cell", {0, 4, 4}); });
  EXPECT_THAT(violations(), ElementsAre("/kelvin/cell row 2: 4, expected cells in their order, each once"));
  change([](hid_t file) {
    test::set_values<std::uint64_t>(file, "/kelvin/cell", {0, 1, 4});
    test::set_values<std::uint32_t>(file, "/kelvin/recording", {0, 2, 7});
  });
  EXPECT_THAT(violations(), ElementsAre("/kelvin/recording row 1: 2, expected a place among the 2 texts"));
}

TEST_F(SweepTables, AreNoRecordingAndNoRecordingIsOne) {
  EXPECT_THROW((void)read_recording(file_), FormatError);
  write_recording(file_, test::sample_recording());
  EXPECT_THAT([&] { const SweepTablesFile read(file_); },
              ThrowsMessage<FormatError>(HasSubstr("found 'kerf.recording', expected 'kerf.sweep'")));
  EXPECT_THAT([&] { const SweepTablesFile read(folder_ / "none.h5"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("expected the tables of a sweep")));
}

}  // namespace
}  // namespace kerf::schema
