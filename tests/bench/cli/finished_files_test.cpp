// No finished file is lost: not to another process with the same name, not half-written to a run that is
// killed.

#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "support/program.h"
#include "support/recordings.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class FinishedFiles : public testing::Test {
 protected:
  /// A line of a shell in the folder, in which "$kerf" is the program.
  [[nodiscard]] Outcome in_shell(const std::string& line) const {
    return test::run({"bash", "-c", "cd \"$0\"; kerf=$1; " + line, folder_.path().string(), KERF_PROGRAM});
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      all.push_back(entry.path().filename().string());
    return all;
  }
  [[nodiscard]] std::vector<std::string> unfinished() const {
    std::vector<std::string> all = names();
    std::erase_if(all, [](const std::string& name) { return name.find(".writing-") == std::string::npos; });
    return all;
  }
  test::TemporaryFolder folder_;
};

constexpr auto import_it = " --map 'time=1[s],position=2[mm],force=3[N]' -o r.h5";

TEST_F(FinishedFiles, OfFourImportsOneHasTheNameAndNoneIsLost) {
  std::string rows;
  for (int i = 0; i < 20'000; ++i) rows += std::to_string(i) + ",1,2\n";
  for (int i = 1; i <= 4; ++i) test::write_text(folder_ / (std::to_string(i) + ".txt"), rows);
  const Outcome outcome = in_shell(std::string("for i in 1 2 3 4; do { \"$kerf\" import $i.txt") + import_it +
                                   "; echo $?; } & done; wait");
  std::multiset<int> statuses;
  std::istringstream lines(outcome.output);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() == 1) statuses.insert(line[0] - '0');
  }
  ASSERT_EQ(statuses.size(), 4U);
  EXPECT_EQ(statuses.count(0), 1U);
  EXPECT_EQ(schema::read_recording(folder_ / "r.h5").rows(), 20'000U);
  EXPECT_THAT(unfinished(), IsEmpty());
  // Who came late was refused before the work (2), or keeps it under a name that it tells (4).
  std::size_t kept = 0;
  for (const std::string& name : names()) {
    if (!name.starts_with("r-")) continue;
    ++kept;
    EXPECT_EQ(schema::read_recording(folder_ / name).rows(), 20'000U);
    EXPECT_THAT(outcome.errors, HasSubstr("kept as " + name));
  }
  EXPECT_EQ(statuses.count(4), kept);
  EXPECT_EQ(statuses.count(2), 3 - kept);
}

TEST_F(FinishedFiles, ARecordingLosesItsNameButNoRow) {
  test::write_text(folder_ / "1.txt", "0,1,2\n1,2,3\n2,3,4\n");
  const Outcome outcome =
      in_shell(std::string("{ \"$kerf\" record --seconds 1.5 -o r.h5; echo recorded $?; } & "
                           "while ! [ -e r.h5.partial ]; do sleep 0.02; done; \"$kerf\" import 1.txt") +
               import_it + " >/dev/null; echo imported $?; wait");
  EXPECT_THAT(outcome.output, HasSubstr("imported 0"));
  EXPECT_THAT(outcome.output, HasSubstr("recorded 4"));
  EXPECT_EQ(schema::read_recording(folder_ / "r.h5").rows(), 3U);
  EXPECT_THAT(outcome.errors, HasSubstr("kept as r-2.h5"));
  const schema::Recording kept = schema::read_recording(folder_ / "r-2.h5");
  EXPECT_EQ(kept.header.status, "complete");
  EXPECT_GT(kept.rows(), 1000U);
  EXPECT_FALSE(fs::exists(folder_ / "r.h5.partial"));
}

TEST_F(FinishedFiles, WithForceTheLastOneHasTheName) {
  test::write_text(folder_ / "1.txt", "0,1,2\n1,2,3\n2,3,4\n");
  const Outcome outcome =
      in_shell(std::string("{ \"$kerf\" record --force --seconds 1 -o r.h5; echo recorded $?; } & "
                           "while ! [ -e r.h5.partial ]; do sleep 0.02; done; \"$kerf\" import 1.txt") +
               import_it + " >/dev/null; wait");
  EXPECT_THAT(outcome.output, HasSubstr("recorded 0"));
  EXPECT_GT(schema::read_recording(folder_ / "r.h5").rows(), 100U);
}

/// A verb that is killed as soon as it has begun to write its folder "out", whose last file is named.
struct Killed {
  const char* name;
  const char* words;
  const char* last_file;
  const char* before = "";  ///< a line that makes what it reads
};

#define KERF_ABX KERF_SOURCE_DIR "/examples/sessions/abx.protocol.toml"
constexpr auto make_a_cut =
    "\"$kerf\" record --device sim:scissors --virtual --seconds 2 -o cut.h5 >/dev/null; ";
constexpr auto make_a_session =
    "\"$kerf\" session key k.key >/dev/null; "
    "\"$kerf\" session new " KERF_ABX
    " --subject S01 --key-file k.key --no-check -o s.h5 >/dev/null; "
    "\"$kerf\" session run s.h5 --key-file k.key --rehearse --no-check >/dev/null 2>&1; ";

class KilledWhileItWrites : public FinishedFiles, public testing::WithParamInterface<Killed> {};

TEST_P(KilledWhileItWrites, LeavesAllOrNothingAndTheNextOneClearsUp) {
  schema::write_recording(folder_ / "r.h5", test::punch());
  const std::string line =
      GetParam().before + std::string("\"$kerf\" ") + GetParam().words +
      " >/dev/null & child=$!; while kill -0 $child 2>/dev/null && ! ls -d out* >/dev/null 2>&1; do :; done; "
      "kill -9 $child 2>/dev/null; wait $child; true";
  (void)in_shell(line);
  const bool is_whole = fs::exists(folder_ / "out" / GetParam().last_file);
  EXPECT_EQ(fs::exists(folder_ / "out"), is_whole);
  const std::vector<std::string> left = unfinished();
  EXPECT_TRUE(is_whole || !left.empty()) << "it began to write";
  const Outcome next = in_shell("\"$kerf\" train --example -o t.csv");
  EXPECT_EQ(next.exit_status, 0);
  for (const std::string& name : left) EXPECT_THAT(next.errors, HasSubstr(name + ": removed"));
  EXPECT_THAT(unfinished(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Of, KilledWhileItWrites,
    testing::Values(
        Killed{"Demo", "demo -o out", "report.html"},
        Killed{"Chart", "chart cut.h5 --laws kelvin,exponential --no-folds --no-cold -o out", "chart.html",
               make_a_cut},
        Killed{"Reproduce", "reproduce Okamura2003 -o out", "claims.json"},
        Killed{"Replay", "replay cut.h5 --through " KERF_SOURCE_DIR "/examples/kelvin.law.toml -o out",
               "replay.html", make_a_cut},
        Killed{"Simulate", "session simulate " KERF_ABX " --experiments 20 --no-curve -o out",
               "simulate.html"},
        Killed{"Open", "session open s.h5 --key-file k.key -o out", "trials.csv", make_a_session},
        Killed{"Study", "session new " KERF_ABX " --subjects 8 --key-file k.key --no-check -o out", "S08.h5",
               "\"$kerf\" session key k.key >/dev/null; "},
        Killed{"Fit", "fit r.h5 --models kelvin -o out", "fit.json"},
        Killed{"Stability", "stability --cells 10 -o out", "stability.json"},
        Killed{"Choose", "choose r.h5 --no-loop -o out", "choose.json"},
        Killed{"Analyze",
               "session analyze " KERF_SOURCE_DIR
               "/examples/sessions/okamura2003-table-1.csv --bootstrap 0 -o out",
               "analysis.html"},
        Killed{"Regress",
               "regress run " KERF_SOURCE_DIR "/examples/regress/kerf.toml --only kelvin --no-cost -o out",
               "regress.html"}),
    [](const auto& tested) { return tested.param.name; });

TEST_F(FinishedFiles, AnOutputNeedsAName) {
  for (const std::string line : {"\"$kerf\" record -o ''", "\"$kerf\" fit r.h5 -o ''"}) {
    const Outcome outcome = in_shell(line);
    EXPECT_EQ(outcome.exit_status, 2) << line;
    EXPECT_THAT(outcome.errors, HasSubstr("'' is no name for an output"));
  }
  EXPECT_THAT(names(), IsEmpty());
}

}  // namespace
}  // namespace kerf
