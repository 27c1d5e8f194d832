#include "drawer/study_file.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

StudyPlan some_plan() {
  StudyPlan plan;
  plan.folder = "../drawer";
  plan.map = "time=1[s],position=2[mm],force=3[N]";
  plan.laws = {"kelvin", "exponential"};
  plan.closing = "increasing";
  plan.blade = "../scalpel.law.toml";
  plan.compare = {"peak", "kelvin.damping"};
  plan.subtracts_blanks = true;
  plan.why_blanks = "friction is \"large\"";
  plan.layouts = {{.files = "rig2/*.csv", .map = "../rig2.import.toml"}};
  plan.licence = "https://creativecommons.org/licenses/by/4.0/";
  plan.people = {"A \"B\" C"};
  plan.files = {{.path = "a\tb.txt",
                 .sha256 = "00",
                 .found = "3 columns",
                 .sheet = "Run 2",
                 .stretch = 2,
                 .axis = "z",
                 .join = "a_force.txt",
                 .join_map = "time=1[s],position=2[mm],force=3[N]",
                 .join_on = "position",
                 .tissue = "liver",
                 .speed = "slow",
                 .specimen = "s1",
                 .rig = "rig2",
                 .less_blank = "air.csv",
                 .accepted = "looked through",
                 .numbers = "7"},
                {.path = "b_position.txt",
                 .join = "b_force.txt",
                 .join_map = "time=1[s],trigger=2[V],force=3[N]",
                 .join_marker = "sync>2.5,trigger>1"},
                {.path = "picture.png", .ignored = "no text"},
                {.path = "air.csv", .blank = true}};
  return plan;
}

class StudyFile : public testing::Test {
 protected:
  StudyPlan read(const std::string& text) {
    test::write_text(folder_ / "study.toml", text);
    return read_study(folder_ / "study.toml");
  }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
      return "accepted";
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(StudyFile, IsReadAsItWasWritten) {
  const StudyPlan plan = some_plan();
  const StudyPlan again = read(study_text(plan));
  EXPECT_EQ(again.folder, (folder_.path() / ".." / "drawer").lexically_normal());
  EXPECT_EQ(again.map, plan.map);
  EXPECT_EQ(again.laws, plan.laws);
  EXPECT_EQ(again.closing, plan.closing);
  EXPECT_EQ(again.blade, "../scalpel.law.toml");
  EXPECT_EQ(again.files[0].axis, "z");
  EXPECT_EQ(again.compare, plan.compare);
  EXPECT_EQ(again.licence, plan.licence);
  EXPECT_EQ(again.people, plan.people);
  ASSERT_EQ(again.files.size(), 4U);
  EXPECT_EQ(again.files[0].less_blank, "air.csv");
  EXPECT_EQ(again.files[0].path, plan.files[0].path);
  EXPECT_EQ(again.files[0].specimen, "s1");
  EXPECT_EQ(again.files[0].rig, "rig2");
  EXPECT_EQ(again.files[0].join, "a_force.txt");
  EXPECT_EQ(again.files[0].join_map, plan.files[0].join_map);
  EXPECT_EQ(again.files[0].join_on, "position");
  EXPECT_EQ(again.files[0].stretch, 2U);
  EXPECT_TRUE(again.subtracts_blanks);
  EXPECT_EQ(again.why_blanks, plan.why_blanks);
  EXPECT_EQ(again.files[0].sheet, "Run 2");
  EXPECT_EQ(again.files[0].accepted, "looked through");
  EXPECT_EQ(again.files[1].join_marker, "sync>2.5,trigger>1");
  EXPECT_EQ(again.files[2].ignored, "no text");
  ASSERT_EQ(again.layouts.size(), 1U);
  EXPECT_EQ(again.layouts[0].files, "rig2/*.csv");
  EXPECT_EQ(again.layouts[0].map, "../rig2.import.toml");
}

TEST_F(StudyFile, RefusesWhatItDoesNotKnowWithItsLine) {
  const std::string good = study_text(some_plan());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return refusal(text);
  };
  EXPECT_THAT(with("version = 1", "version = 2"), HasSubstr("expected version = 1"));
  EXPECT_THAT(with("laws = [\"kelvin\"", "laws = [\"kelwin\""), HasSubstr("kelwin"));
  EXPECT_THAT(with("kelvin.damping", "maxwell.stiffness_1"), HasSubstr("'maxwell.stiffness_1'"));
  EXPECT_THAT(with("cycles = \"good\"", "cycles = \"fine\""), HasSubstr("fine"));
  EXPECT_THAT(with("closing = \"increasing\"", "closing = \"up\""), HasSubstr("\"up\""));
  EXPECT_THAT(with("path = \"picture.png\"", "path = \"../picture.png\""), HasSubstr("below the drawer"));
  EXPECT_THAT(with("path = \"picture.png\"", "path = \"pictures/\""), HasSubstr("below the drawer"));
  EXPECT_THAT(with("path = \"picture.png\"", "path = \"a\\tb.txt\""), HasSubstr("a second time"));
  EXPECT_THAT(with("join_on = \"position\"\n", ""), HasSubstr("needs 'join_map'"));
  EXPECT_THAT(with("join_marker = \"sync>2.5,trigger>1\"\n", ""), HasSubstr("or 'join_marker'"));
  EXPECT_THAT(with("join_marker = \"sync>2.5,trigger>1\"", "join_marker = \"sync>2.5V\""),
              testing::AllOf(HasSubstr("study.toml:"), HasSubstr("join_marker"), HasSubstr("2.5V")));
  EXPECT_THAT(with("join_on = \"position\"", "join_on = \"position\"\njoin_marker = \"sync\""),
              HasSubstr("two ways"));
  EXPECT_THAT(with("join = \"a_force.txt\"", "join = \"../a_force.txt\""), HasSubstr("below the drawer"));
  EXPECT_THAT(with("path = \"picture.png\"\nignored = \"no text\"", "path = \"a_force.txt\""),
              HasSubstr("takes part itself"));
  EXPECT_THAT(with("blank = \"subtract\"", "blank = \"off\""), HasSubstr("not \"off\""));
  EXPECT_THAT(with("less_blank = \"air.csv\"", "less_blank = \"picture.png\""),
              HasSubstr("which is no [[file]] with blank = true"));
  EXPECT_THAT(with("blank = true", "blank = true\nless_blank = \"air.csv\""), HasSubstr("is a blank"));
  EXPECT_THAT(with("files = \"rig2/*.csv\"\n", ""), HasSubstr("needs 'files'"));
  EXPECT_THAT(with("tissue = \"liver\"", "tisue = \"liver\""), HasSubstr("tisue"));
}

// Files of an earlier version say nothing of it.
TEST_F(StudyFile, LeavesBlanksWhereItDoesNotSay) {
  std::string text = study_text(some_plan());
  const auto prepare = text.find("[prepare]");
  text.erase(prepare, text.find("[[layout]]", prepare) - prepare);
  EXPECT_FALSE(read(text).subtracts_blanks);
}

// The narrower word wins: a file's own, then the first layout whose pattern it fits, then the study's.
TEST(StudyMap, IsTheFilesOwnElseOfItsLayoutElseOfTheStudy) {
  StudyPlan plan;
  plan.map = "study";
  plan.layouts = {{.files = "rig2/*.csv", .map = "rig2"}, {.files = "*.csv", .map = "any"}};
  EXPECT_EQ(plan.map_of({.path = "rig2/a/b.csv", .map = "own"}), "own");
  EXPECT_EQ(plan.map_of({.path = "rig2/a/b.csv"}), "rig2");
  EXPECT_EQ(plan.map_of({.path = "rig1/b.csv"}), "any");
  EXPECT_EQ(plan.map_of({.path = "rig2/b.txt"}), "study");
}

TEST(RecordingNames, AreOfTheFilesThatTakePartAndDiffer) {
  StudyPlan plan;
  plan.files = {
      {.path = "slow/liver 1.txt"}, {.path = "fast/liver 1.txt"}, {.path = "x.png", .ignored = "no text"}};
  EXPECT_EQ(recording_names(plan), (std::vector<std::string>{"liver_1", "liver_1-2", ""}));
}

}  // namespace
}  // namespace kerf::bench
