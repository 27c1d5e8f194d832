#include <limits>
#include <ostream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/validate.h>

#include "datasets-schema/changed_file.h"

namespace kerf::schema {

void PrintTo(const Violation& violation, std::ostream* stream) {
  *stream << violation.where << ": " << violation.found << ", expected " << violation.expected;
}

namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;

auto violation(const std::string& where, const std::string& found, const std::string& expected) {
  return AllOf(Field("where", &Violation::where, where), Field("found", &Violation::found, HasSubstr(found)),
               Field("expected", &Violation::expected, HasSubstr(expected)));
}

std::vector<Violation> violations_after(const std::function<void(hid_t)>& change) {
  return validate(test::ChangedFile(change).path());
}

std::vector<Violation> violations_of(const Recording& recording) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", recording);
  return validate(folder / "r.h5");
}

TEST(Validate, FindsNothingInAPhaseThatHoldsNoRow) {
  auto recording = test::sample_recording();
  recording.cycles->phases = {{.cycle = 1, .phase = Phase::closing}};
  EXPECT_THAT(violations_of(recording), IsEmpty());
}

TEST(Validate, FindsNothingInWhatTheWriterWrites) {
  EXPECT_THAT(violations_of(test::sample_recording()), IsEmpty());
  EXPECT_THAT(violations_of(test::sample_recording(100'000)), IsEmpty());
  EXPECT_THAT(violations_of([] {
                auto recording = test::sample_recording(0);
                recording.cycles.reset();
                return recording;
              }()),
              IsEmpty());
}

TEST(Validate, NamesAFlagOfACycleThatIsNotThere) {
  auto recording = test::sample_recording();
  const std::uint32_t last = recording.cycles->phases.back().cycle;
  recording.cycle_flags = {.created = "2026-01-31T12:00:00Z",
                           .software = "kerf test",
                           .flags = {{.cycle = last, .fault = "by_hand", .reason = "slipped"}}};
  EXPECT_THAT(violations_of(recording), IsEmpty());
  recording.cycle_flags->flags.push_back({.cycle = last + 1, .fault = "outlier", .reason = "far"});
  EXPECT_THAT(
      violations_of(recording),
      ElementsAre(violation("/cycle_flags/flags", "cycle " + std::to_string(last + 1), "a cycle from 1")));
}

TEST(Validate, NamesAMissingDataset) {
  EXPECT_THAT(violations_after([](hid_t file) { test::remove_link(file, "/samples/velocity"); }),
              ElementsAre(violation("/samples/velocity", "nothing", "a dataset of float64")));
}

TEST(Validate, NamesAMissingGroupOnce) {
  EXPECT_THAT(violations_after([](hid_t file) { test::remove_link(file, "/samples"); }),
              ElementsAre(violation("/samples", "nothing", "a group")));
}

TEST(Validate, AcceptsThatOptionalDatasetsAreAbsent) {
  EXPECT_THAT(violations_after([](hid_t file) {
                test::remove_link(file, "/samples/force_measured");
                test::remove_link(file, "/samples/flags");
                test::remove_link(file, "/cycles");
                test::remove_link(file, "/device");
              }),
              IsEmpty());
}

TEST(Validate, NamesAWrongType) {
  EXPECT_THAT(violations_after([](hid_t file) {
                test::replace_dataset<float>(file, "/samples/position", {5, 2});
              }),
              Contains(violation("/samples/position", "float32", "float64")));
}

TEST(Validate, NamesAWrongNumberOfDimensions) {
  EXPECT_THAT(
      violations_after([](hid_t file) { test::replace_dataset<double>(file, "/samples/position", {5}); }),
      Contains(violation("/samples/position", "1 dimensions", "2")));
}

TEST(Validate, NamesRowCountsThatDiffer) {
  EXPECT_THAT(
      violations_after([](hid_t file) { test::replace_dataset<float>(file, "/samples/read_time", {4}); }),
      Contains(violation("/samples/read_time", "4 rows", "5 as in /samples/time")));
}

TEST(Validate, NamesAnotherNumberOfColumnsThanAxes) {
  EXPECT_THAT(violations_after([](hid_t file) {
                test::replace_dataset<double>(file, "/samples/velocity", {5, 3});
              }),
              Contains(violation("/samples/velocity", "3 columns", "2 as in /samples attribute 'axes'")));
}

TEST(Validate, NamesMissingUnitsAndScale) {
  EXPECT_THAT(
      violations_after([](hid_t file) { test::replace_dataset<float>(file, "/samples/write_time", {5}); }),
      ElementsAre(violation("/samples/write_time attribute 'units'", "nothing", "a unit"),
                  violation("/samples/write_time", "no dimension scale", "/samples/time")));
}

TEST(Validate, NamesTimesThatAreNoScale) {
  EXPECT_THAT(violations_after([](hid_t file) { test::remove_attribute(file, "/samples/time", "CLASS"); }),
              Contains(violation("/samples/time", "no dimension scale", "a dimension scale")));
}

TEST(Validate, NamesUnitsThatDoNotFitTheAxes) {
  EXPECT_THAT(violations_after([](hid_t file) { test::set_text(file, "/samples/time", "units", "ms"); }),
              ElementsAre(violation("/samples/time attribute 'units'", "'ms'", "'s'")));
}

TEST(Validate, NamesAMissingAttribute) {
  EXPECT_THAT(violations_after([](hid_t file) { test::remove_attribute(file, "/", "uuid"); }),
              ElementsAre(violation("/ attribute 'uuid'", "nothing", "text")));
}

TEST(Validate, NamesAnAttributeOfAnotherType) {
  EXPECT_THAT(violations_after([](hid_t file) { test::set_number(file, "/", "created", 3.0); }),
              ElementsAre(violation("/ attribute 'created'", "float64", "text")));
}

TEST(Validate, NamesAUnitOfAChannelThatIsNoText) {
  EXPECT_THAT(
      violations_after([](hid_t file) { test::set_number(file, "/samples/channels/a", "units", 3.0); }),
      ElementsAre(violation("/samples/channels/a attribute 'units'", "float64", "one text")));
}

TEST(Validate, NamesWhatItDoesNotKnow) {
  EXPECT_THAT(violations_after([](hid_t file) {
                test::set_text(file, "/", "note", "x");
                test::set_text(file, "/samples/time", "note", "x");
                static_cast<void>(h5::create_group(file, "/samples/extra"));
              }),
              ElementsAre(violation("/ attribute 'note'", "an attribute", "nothing"),
                          violation("/samples/extra", "an object", "nothing"),
                          violation("/samples/time attribute 'note'", "an attribute", "nothing")));
}

TEST(Validate, LeavesDeviceAndSceneRoomForTheirOwn) {
  EXPECT_THAT(violations_after([](hid_t file) { test::set_text(file, "/scene", "cutter", "left-handed"); }),
              IsEmpty());
}

TEST(Validate, NamesABadStatus) {
  EXPECT_THAT(violations_after([](hid_t file) { test::set_text(file, "/", "status", "done"); }),
              ElementsAre(violation("/ attribute 'status'", "'done'", "'complete'")));
}

TEST(Validate, AcceptsAnAbortedRecording) {
  EXPECT_THAT(
      violations_after([](hid_t file) { test::set_text(file, "/", "status", "aborted: cable\nout"); }),
      IsEmpty());
}

TEST(Validate, NamesAUuidOfAnotherForm) {
  EXPECT_THAT(violations_after([](hid_t file) { test::set_text(file, "/", "uuid", "42"); }),
              ElementsAre(violation("/ attribute 'uuid'", "'42'", "8-4-4-4-12")));
}

TEST(Validate, NamesADateThatIsNotUtc) {
  EXPECT_THAT(violations_after([](hid_t file) { test::set_text(file, "/", "created", "31.01.2026 12:00"); }),
              ElementsAre(violation("/ attribute 'created'", "31.01.2026", "UTC")));
}

TEST(Validate, NamesOtherFlagBits) {
  EXPECT_THAT(
      violations_after([](hid_t file) { test::set_text(file, "/samples/flags", "flag_meanings", "a b"); }),
      ElementsAre(violation("/samples/flags attribute 'flag_meanings'", "'a b'", "missed_deadline")));
}

TEST(Validate, TakesARecordingOfAVersionThatKnewFewerFlags) {
  for (const char* const flags : {"12", "13"}) {
    const std::filesystem::path golden =
        std::string(KERF_SOURCE_DIR "/tests/datasets-schema/golden/recording-") + flags + "-flags.h5";
    EXPECT_THAT(validate(golden), IsEmpty()) << flags;
    const Recording recording = read_recording(golden);
    EXPECT_EQ(recording.rows(), 20U) << flags;
    EXPECT_NE(recording.flags[10] & flag_soft_start, 0U) << flags;
  }
  EXPECT_THAT(
      violations_after([](hid_t file) {
        test::set_text(file, "/samples/flags", "flag_meanings", "missed_deadline force_limited");
      }),
      ElementsAre(violation("/samples/flags attribute 'flag_meanings'", "'missed_deadline", "sensor_fault")))
      << "no version knew as few as that";
}

TEST(Validate, NamesEditsOfCyclesThatDoNotHoldTogether) {
  const auto after = [](const std::function<void(std::vector<CycleChange>&)>& spoil) {
    auto recording = test::sample_recording();
    recording.cycle_edits = test::sample_cycle_changes();
    spoil(recording.cycle_edits);
    return violations_of(recording);
  };
  const auto changes = [](const char* found, const char* expected) {
    return ElementsAre(violation("/cycle_edits/changes", found, expected));
  };
  EXPECT_THAT(after([](auto&) {}), IsEmpty());
  EXPECT_THAT(after([](auto& it) { it[1].kind = "guessed"; }), changes("kind 'guessed' in row 1", "a kind"));
  EXPECT_THAT(after([](auto& it) { it[2].time = "today"; }), changes("time 'today' in row 2", "ISO 8601"));
  EXPECT_THAT(after([](auto& it) { it[2].author.clear(); }), changes("no author in row 2", "an author"));
  EXPECT_THAT(after([](auto& it) { it[0].phase = 5; }), changes("phase 5 in row 0", "from 1 to 4, or 0"));
  EXPECT_THAT(after([](auto& it) { it[0].row_after = -2; }),
              changes("a row below -1 in row 0", "rows, or -1"));
  EXPECT_THAT(after([](auto& it) { it[2].edit = 4; }), changes("edit 4 in row 2", "counted from 1"));
  EXPECT_THAT(after([](auto& it) { it[1].author = "Bo"; }), changes("edit 1 in row 1", "one author"));
  EXPECT_THAT(violations_after([](hid_t file) {
                ASSERT_GE(H5Gclose(H5Gcreate2(file, "cycle_edits", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)),
                          0);
              }),
              ElementsAre(violation("/cycle_edits/changes", "nothing", "a dataset of {edit uint32")));
}

TEST(Validate, NamesTimesThatDoNotIncrease) {
  auto recording = test::sample_recording();
  recording.time = {0.0, 0.002, 0.002, 0.001, 0.004};
  EXPECT_THAT(violations_of(recording),
              ElementsAre(violation("/samples/time", "0.002000 s after 0.002000 s in row 2, and 1 more",
                                    "increase strictly")));
}

TEST(Validate, NamesTimesThatAreNotFinite) {
  auto recording = test::sample_recording();
  recording.time[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(violations_of(recording), ElementsAre(violation("/samples/time", "nan s in row 4", "finite")));
}

TEST(Validate, NamesTicksThatDoNotIncrease) {
  auto recording = test::sample_recording();
  recording.tick = {0, 1, 1, 2, 3};
  EXPECT_THAT(violations_of(recording),
              ElementsAre(violation("/samples/tick", "1 after 1 in row 2", "increase strictly")));
}

TEST(Validate, NamesCyclesOutOfRange) {
  auto recording = test::sample_recording();
  auto& cycles = *recording.cycles;
  cycles.phases[0].end = 6;
  cycles.phases[1].phase = static_cast<Phase>(5);
  cycles.closing_direction = 0.5;
  cycles.grid = {0.0, 0.2, 0.1};
  EXPECT_THAT(violations_of(recording),
              ElementsAre(violation("/cycles attribute 'closing_direction'", "0.5", "+1 or -1"),
                          violation("/cycles/phases", "rows [0, 6) in row 0", "[0, 5)"),
                          violation("/cycles/phases", "phase 5", "1 to 4"),
                          violation("/cycles/grid", "0.100000 after 0.200000", "increase strictly")));
}

TEST(Validate, NamesACycleAxisThatIsNotThere) {
  auto recording = test::sample_recording();
  recording.cycles->axis = 2;
  EXPECT_THAT(violations_of(recording), Contains(violation("/cycles attribute 'axis'", "2", "less than 2")));
}

TEST(Validate, NamesUnitsThatAreNotSi) {
  auto recording = test::sample_recording();
  recording.axes[1].position_unit = "mm";
  EXPECT_THAT(violations_of(recording),
              ElementsAre(violation("/samples/position attribute 'units'", "'mm'", "'m'")));
}

}  // namespace
}  // namespace kerf::schema
