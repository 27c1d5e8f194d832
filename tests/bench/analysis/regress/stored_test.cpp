#include <cmath>
#include <limits>
#include <set>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <unistd.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/validate.h>

#include "bench/analysis/regress/small_suite.h"
#include "regress/run.h"
#include "regress/stored/stored_suite.h"
#include "regress/stored/summary.h"
#include "regress/stored/text_forces.h"

// What stands beside a suite, for people, diffs and merges.

namespace kerf::bench {
namespace {

using test::Outcome;
using test::run_kerf;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class StoredBeside : public testing::Test {
 protected:
  [[nodiscard]] Outcome kerf(const std::string& action, const std::vector<std::string>& more = {}) const {
    return folder_.regress(action, more);
  }
  [[nodiscard]] Outcome store(const std::string& reason = "first forces") const {
    return kerf("update", {"--reason", reason, "--yes"});
  }
  [[nodiscard]] std::string read(const std::string& name) const { return test::read_text(folder_.at(name)); }
  void write(const std::string& name, const std::string& text) const {
    test::write_text(folder_.at(name), text);
  }
  void replace(const std::string& name, const std::string& from, const std::string& to) const {
    test::replace_in(folder_.at(name), from, to);
  }
  /// The case of the suite, and the same under another name.
  void write_two_cases(const std::string& head = "") const {
    std::string second = std::string(test::one_case).substr(std::string(test::one_case).find("[[case]]"));
    second.replace(second.find("kelvin"), 6, "second, half as fast");
    folder_.write_suite(head + test::one_case + second);
  }
  test::SuiteFolder folder_;
};

TEST_F(StoredBeside, SummaryShowsWhatADiffOfABinaryDoesNot) {
  write_two_cases();
  ASSERT_EQ(store().exit_status, 0);
  const std::string before = read("suite.forces.txt");
  EXPECT_THAT(before,
              AllOf(HasSubstr("[kelvin]"), HasSubstr("[second, half as fast]"),
                    HasSubstr("parameters parallel_stiffness 8 N/rad, series_stiffness 7 N/rad"),
                    HasSubstr("reason     first forces"), HasSubstr("ticks      400, 0 faults"),
                    HasSubstr("theta      peak "), HasSubstr(" N·rad\n"), HasSubstr("RMS 20 to 40 Hz")));
  // One case changes: what is said of the other stays to the letter.
  folder_.change_law("value = 8,", "value = 8.1,");
  ASSERT_EQ(kerf("update", {"--reason", "stiffer", "--yes", "--only", "kelvin"}).exit_status, 0);
  const std::string after = read("suite.forces.txt");
  const std::string second = before.substr(before.find("[second"));
  EXPECT_THAT(after, AllOf(HasSubstr("parallel_stiffness 8.1 N/rad"), HasSubstr("reason     stiffer"),
                           HasSubstr(second)));
  EXPECT_THAT(run_kerf({"regress", "run", folder_.suite()}).errors, Not(HasSubstr("forces.txt")));
}

TEST_F(StoredBeside, SummaryIsMissedAndMadeWithoutTouchingAForce) {
  ASSERT_EQ(store().exit_status, 0);
  const std::string forces = read("suite.h5");
  const std::string summary = read("suite.forces.txt");
  std::filesystem::remove(folder_.at("suite.forces.txt"));
  const Outcome run = kerf("run");
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_THAT(run.errors, AllOf(HasSubstr("suite.forces.txt is missing"), HasSubstr("kerf regress update")));
  const Outcome update = store("nothing new");
  EXPECT_THAT(update.output, HasSubstr("every force stays as it is"));
  EXPECT_EQ(read("suite.forces.txt"), summary);
  EXPECT_EQ(schema::read_regression(folder_.at("suite.h5"))[0].reason, "first forces");
  EXPECT_THAT(store("nothing new").output, HasSubstr("suite.h5 stays as it is"));
}

TEST_F(StoredBeside, SummaryOfOtherForcesIsSaidAndAFalseOneDoesNotPass) {
  ASSERT_EQ(store().exit_status, 0);
  const std::string summary = read("suite.forces.txt");
  const auto at = summary.find("stored     ") + 11;
  write("suite.forces.txt", std::string(summary).replace(at, 4, "1999"));
  const Outcome stale = kerf("run");
  EXPECT_EQ(stale.exit_status, 0) << "the forces are as they were";
  EXPECT_THAT(stale.errors, HasSubstr("is of other forces than"));
  const auto hash = summary.find("forces     ", at) + 11;
  write("suite.forces.txt", std::string(summary).replace(hash, 4, "0000"));
  const Outcome wrong = kerf("run", {"--junit", folder_.at("r.xml")});
  EXPECT_EQ(wrong.exit_status, 2) << "its only case could not be compared";
  EXPECT_THAT(wrong.output, HasSubstr("says that other forces were stored on"));
  EXPECT_THAT(read("r.xml"), HasSubstr("<error message="));
}

TEST_F(StoredBeside, AMergeThatConflictsSaysWhatToDo) {
  ASSERT_EQ(store().exit_status, 0);
  const std::string conflict = "<<<<<<< HEAD\nreason     mine\n=======\nreason     yours\n>>>>>>> other\n";
  const std::string summary = read("suite.forces.txt");
  const auto at = summary.find("reason");
  write("suite.forces.txt", std::string(summary).replace(at, summary.find('\n', at) + 1 - at, conflict));
  const Outcome text = kerf("run");
  EXPECT_EQ(text.exit_status, 2);
  EXPECT_THAT(text.errors, AllOf(HasSubstr("suite.forces.txt:10: a merge left a conflict here"),
                                 HasSubstr("git checkout --ours"), HasSubstr("kerf regress update")));
  EXPECT_EQ(store("after the merge").exit_status, 0) << "whose side was taken";
  EXPECT_EQ(read("suite.forces.txt"), summary);
  // Binary files have no marks; pointers of Git LFS are text.
  const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:12ab\nsize 1\n";
  write("suite.h5", pointer);
  EXPECT_THAT(kerf("run").errors, HasSubstr("'git lfs pull' fetches it"));
  write("suite.h5", "<<<<<<< HEAD\n" + pointer + "=======\n" + pointer + ">>>>>>> other\n");
  EXPECT_THAT(kerf("run").errors, HasSubstr("suite.h5:1: a merge left a conflict here"));
  EXPECT_EQ(store("over it").exit_status, 2) << "what cannot be read is not replaced";
}

TEST_F(StoredBeside, TextIsAFileACaseAndTheSameBits) {
  write_two_cases();
  ASSERT_EQ(store().exit_status, 0);
  const auto binary = schema::read_regression(folder_.at("suite.h5"));
  write_two_cases("references = \"text\"\n");
  EXPECT_EQ(kerf("run").exit_status, 0) << "until it is updated the forces are where they were";
  ASSERT_EQ(store("as text").exit_status, 0);
  const StoredSuite text = read_stored(read_suite(folder_.suite()));
  ASSERT_EQ(text.cases.size(), 2U);
  const auto same = std::ranges::find(text.cases, binary[0].name, &schema::StoredForces::name);
  EXPECT_EQ(same->force, binary[0].force);
  EXPECT_EQ(same->reason, "first forces");
  EXPECT_EQ(same->software, binary[0].software);
  EXPECT_THAT(read("suite.forces/kelvin.csv"), HasSubstr("\ntick,theta[N]\n0,0\n1,0\n"));
  std::filesystem::remove(folder_.at("suite.h5"));
  EXPECT_EQ(kerf("run").exit_status, 0);
  // One case changes: the other's file is not touched.
  const std::string other = read("suite.forces/" + text_file_of("second, half as fast"));
  folder_.change_law("value = 8,", "value = 8.1,");
  ASSERT_EQ(kerf("update", {"--reason", "stiffer", "--yes", "--only", "kelvin"}).exit_status, 0);
  EXPECT_EQ(read("suite.forces/" + text_file_of("second, half as fast")), other);
  EXPECT_THAT(read("suite.forces/kelvin.csv"), HasSubstr("# history: 20"));
  folder_.change_law("value = 8.1,", "value = 8.2,");
  ASSERT_EQ(kerf("update", {"--reason", "stiffer still", "--yes", "--only", "kelvin"}).exit_status, 0);
  EXPECT_THAT(read("suite.forces/kelvin.csv"), AllOf(HasSubstr(": first forces\n"), HasSubstr(": stiffer\n")))
      << "what was read is written again";
  // A case that goes takes its file along.
  folder_.write_suite("references = \"text\"\n" + std::string(test::one_case));
  ASSERT_EQ(store("one is enough").exit_status, 0);
  EXPECT_FALSE(std::filesystem::exists(folder_.at("suite.forces/" + text_file_of("second, half as fast"))));
}

TEST_F(StoredBeside, TextThatIsWrongIsAnErrorOfItsCaseAlone) {
  write_two_cases("references = \"text\"\n");
  ASSERT_EQ(store().exit_status, 0);
  const std::string file = "suite.forces/kelvin.csv";
  const std::string sound = read(file);
  const auto wrong = [&](const std::string& from, const std::string& to, const std::string& message) {
    write(file, sound);
    replace(file, from, to);
    const Outcome outcome = kerf("run");
    EXPECT_EQ(outcome.exit_status, 1) << "the other case runs";
    EXPECT_THAT(outcome.output, AllOf(HasSubstr("kelvin.csv"), HasSubstr(message)));
  };
  wrong("\n7,", "\n<<<<<<< HEAD\n7,", "a merge left a conflict here");
  wrong("\n7,", "\n8,", "found tick 8 in row 7");
  wrong("\n7,", "\n7,x", "expected a number");
  wrong("kerf.regression: 1", "kerf.regression: 2", "found version 2 of kerf.regression, expected 1");
  wrong("case: kelvin", "case: other", "it says that it is of case 'other'");
  wrong("theta[N]", "theta", "expected a name with its unit");
  write(file, sound);
  EXPECT_EQ(kerf("run").exit_status, 0);
}

TEST_F(StoredBeside, TextKeepsWhatIsNoNumber) {
  schema::StoredForces one{.name = "kelvin", .model = "kelvin", .channels = {{"x", "N"}, {"rx", "N·m"}}};
  one.force = {-0.0,         std::numeric_limits<double>::denorm_min(), 0.1 + 0.2,
               std::nan(""), -std::numeric_limits<double>::infinity(),  1e300};
  test::write_text(folder_.at("kelvin.csv"), forces_as_text(one));
  const auto back =
      read_forces_text(folder_.at("kelvin.csv"), {.name = "", .file = "", .stored = "", .cases = {}});
  ASSERT_EQ(back.force.size(), one.force.size());
  EXPECT_TRUE(std::signbit(back.force[0]));
  EXPECT_EQ(back.force[1], one.force[1]);
  EXPECT_EQ(back.force[2], one.force[2]);
  EXPECT_TRUE(std::isnan(back.force[3]));
  EXPECT_EQ(back.force[4], one.force[4]);
  EXPECT_EQ(back.channels[1].unit, "N·m");
  EXPECT_NE(text_file_of("a b"), text_file_of("a_b")) << "no two cases have one file";
}

TEST_F(StoredBeside, FilesOfTwoSuitesNeverCollide) {
  for (const char* name : {"a.toml", "a.forces.toml", "a.suite", "a.h5.toml"}) {
    write(name, std::string(test::one_case) + "# " + name);
    for (const char* form : {"", "references = \"text\"\n"}) {
      write(name, form + std::string(test::one_case));
      ASSERT_EQ(run_kerf({"regress", "update", folder_.at(name), "--reason", "first", "--yes"}).exit_status,
                0);
    }
  }
  std::set<std::string> places;
  for (const char* name : {"a.toml", "a.forces.toml", "a.suite", "a.h5.toml"}) {
    const Suite suite = read_suite(folder_.at(name));
    EXPECT_TRUE(places.insert(suite.stored).second) << suite.stored;
    EXPECT_TRUE(places.insert(summary_file(suite)).second) << summary_file(suite);
    EXPECT_EQ(run_kerf({"regress", "run", folder_.at(name)}).exit_status, 0);
  }
}

TEST_F(StoredBeside, ForcesAreNotStoredOverTheRecordingThatTheyAreOf) {
  folder_.write_suite(
      "[[case]]\nname = \"kelvin\"\nlaw = \"kelvin.law.toml\"\nrecording = \"suite.h5\"\nexact = true\n");
  write("suite.h5", "a recording");
  const Outcome outcome = store();
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("suite.h5 is what case 'kelvin' moves along, and where the forces"));
  EXPECT_EQ(read("suite.h5"), "a recording");
}

TEST_F(StoredBeside, TwoAtOnceAreToldApart) {
  ASSERT_EQ(store().exit_status, 0);
  const int other = ::open(folder_.suite().c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_SH), 0);  // as a run holds it
  EXPECT_EQ(kerf("run").exit_status, 0) << "runs go side by side";
  const std::string before = read("suite.h5");
  folder_.change_law("value = 8,", "value = 9,");
  const Outcome update = store("stiffer");
  EXPECT_EQ(update.exit_status, 2);
  EXPECT_THAT(update.errors, HasSubstr("another 'kerf regress' is at work on this suite"));
  EXPECT_EQ(read("suite.h5"), before);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);  // as an update does
  const Outcome run = kerf("run");
  EXPECT_EQ(run.exit_status, 2);
  EXPECT_THAT(run.errors, HasSubstr("a 'kerf regress update' is storing forces of this suite"));
  ::close(other);
}

/// A closing of a second in 1000 ticks.
schema::Recording closing_of_a_second() {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  for (int i = 0; i < 1000; ++i) {
    recording.time.push_back(1e-3 * i);
    recording.tick.push_back(static_cast<std::uint64_t>(i));
    recording.position.push_back(0.6 - 5e-4 * i + 0.01 * std::sin(0.05 * i));
    recording.velocity.push_back(-0.5 + 0.5 * std::cos(0.05 * i));
  }
  return recording;
}

TEST_F(StoredBeside, ATrajectoryIsKeptOnceARecordingAndComparedWithTheNewOne) {
  schema::Recording recording = closing_of_a_second();
  schema::write_recording(folder_.at("cut.h5"), recording);
  const std::string one = "law = \"kelvin.law.toml\"\nrecording = \"cut.h5\"\njnd = 0.01\n";
  for (const char* form : {"", "references = \"text\"\n"}) {
    folder_.write_suite(form + ("[[case]]\nname = \"a\"\n" + one) + "[[case]]\nname = \"b\"\n" + one);
    ASSERT_EQ(store().exit_status, 0);
    const StoredSuite stored = read_stored(read_suite(folder_.suite()));
    for (const schema::StoredForces& each : stored.cases)
      EXPECT_EQ(each.trajectory.position, recording.position);
  }
  const auto files = std::filesystem::directory_iterator(folder_.at("suite.forces/trajectories"));
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
  EXPECT_THAT(schema::validate(folder_.at("suite.h5")), IsEmpty());
  // The path is another, and so are the forces: that says more than that some number is other.
  for (double& position : recording.position) position -= 0.002;
  schema::write_recording(folder_.at("cut.h5"), recording);
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("the trajectory has changed since"));
}

TEST_F(StoredBeside, AStoredNumberThatIsNotFiniteNeverPasses) {
  ASSERT_EQ(store().exit_status, 0);
  auto stored = schema::read_regression(folder_.at("suite.h5"));
  stored[0].force[300] = std::nan("");
  schema::write_regression(folder_.at("suite.h5"), stored);
  std::filesystem::remove(folder_.at("suite.forces.txt"));
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("no finite number from tick 300 on: it was never right"));
}

TEST_F(StoredBeside, AFileOfWhichHalfIsThereIsAnErrorInOneLine) {
  ASSERT_EQ(store().exit_status, 0);
  std::filesystem::resize_file(folder_.at("suite.h5"),
                               std::filesystem::file_size(folder_.at("suite.h5")) / 2);
  const Outcome outcome = kerf("run");
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("suite.h5"));
  EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
}

}  // namespace
}  // namespace kerf::bench
