#include "plan/sweep_file.h"

#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

class SweepFile : public test::SweepFolder {
 protected:
  [[nodiscard]] std::string refusal(const std::string& toml) const {
    test::write_text(file("w.toml"), toml);
    try {
      (void)read_sweep(file("w.toml"));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  [[nodiscard]] std::string refusal_of_cells(const std::string& cells) const {
    return refusal("version = 1\nverb = \"stability\"\n[cells]\n" + cells);
  }
};

TEST_F(SweepFile, IsRefusedWithItsLine) {
  EXPECT_THAT(refusal("verb = \"fit\"\n"), HasSubstr("w.toml:1: expected version = 1"));
  EXPECT_THAT(refusal("version = 1\nverb = \"fits\"\n"),
              HasSubstr("w.toml:2: a sweep runs no verb 'fits'; it runs fit, stability, identify, check"));
  EXPECT_THAT(refusal("version = 1\nverb = \"stability\"\n"), HasSubstr("a sweep needs [cells]"));
  EXPECT_THAT(refusal_of_cells("mass = 1\n"), HasSubstr("cells of 'stability' need 'stiffness'"));
  EXPECT_THAT(refusal_of_cells("mass = 1\nstiffnes = 1\n"), HasSubstr("w.toml:5: unknown key 'stiffnes'"));
  EXPECT_THAT(refusal_of_cells("mass = 1\nstiffness = \"much\"\n"),
              HasSubstr("w.toml:5: 'stiffness': it takes a number"));
  EXPECT_THAT(refusal_of_cells("mass = [1, -1]\nstiffness = 1\n"),
              HasSubstr("w.toml:4: 'mass': -1 is not within"));
  EXPECT_THAT(refusal_of_cells("mass = []\nstiffness = 1\n"), HasSubstr("the list is empty"));
  EXPECT_THAT(refusal_of_cells("mass = 1\nstiffness = 1\ngrip = \"soft\"\n"),
              HasSubstr("'soft' is not one of none, light, firm, arm"));
  EXPECT_THAT(
      refusal_of_cells("mass = 1\nstiffness = { from = 0, to = 1, count = 3, scale = \"logarithmic\" }\n"),
      HasSubstr("ends greater than 0"));
  EXPECT_THAT(refusal_of_cells("mass = 1\nstiffness = { from = 1, to = 2 }\n"), HasSubstr("needs a 'count'"));
  EXPECT_THAT(refusal("version = 1\nverb = \"fit\"\n[cells]\nrecording = \"none.h5\"\nlaw = \"kelvin\"\n"),
              HasSubstr("none.h5"));
  EXPECT_THAT(refusal("version = 1\nverb = \"stability\"\nshards = 0\n[cells]\nmass = 1\nstiffness = 1\n"),
              HasSubstr("w.toml:3: 'shards'"));
}

TEST_F(SweepFile, TakesAFolderForAllRecordingsInIt) {
  std::filesystem::create_directories(file("all/deep"));
  for (const char* name : {"all/a.h5", "all/deep/b.h5"})
    schema::write_recording(file(name), test::punch({.seconds = 0.1}));
  const SweepPlan plan =
      plan_of("version = 1\nverb = \"fit\"\n[cells]\nrecording = \"all\"\nlaw = [\"kelvin\", \"friction\"]\n")
          .plan;
  ASSERT_EQ(plan.cells(), 4U);
  EXPECT_EQ(plan.cell(1).text("recording"), "all/a.h5");
  EXPECT_EQ(plan.cell(2).text("recording"), "all/deep/b.h5");
}

}  // namespace
}  // namespace kerf::bench
