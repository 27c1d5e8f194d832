// docs/command-line.md has one table of exit statuses. Every verb follows it: a named input that is missing
// or cannot be read is 2, an output that cannot be written is 4.

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/recording_writer.h>

#include "bench/cli/verbs.h"
#include "bench/sessions/protocol/written_protocol.h"
#include "support/kelvin_law.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf {
namespace {

namespace fs = std::filesystem;
using test::Outcome;
using test::run_kerf;
using Words = std::vector<std::string>;

// The words of commands: INPUT and OUTPUT stand for what is wrong, FOLDER/ for a folder of good files.

// Verbs that read no file: what they need is in the program, or on the USB.
const std::set<Words> without_input{{"devices"},       {"doctor"},    {"laws"},          {"law", "new"},
                                    {"device", "new"}, {"reproduce"}, {"session", "key"}};
// Verbs that write no file, or one only where it was named as their input.
const std::set<Words> without_output{{"devices"},
                                     {"doctor"},
                                     {"laws"},
                                     {"info"},
                                     {"inspect"},
                                     {"validate"},
                                     {"studio"},
                                     {"session", "run"},
                                     {"session", "drop"},
                                     {"session", "note"},
                                     {"session", "status"},
                                     {"study", "run"},
                                     {"study", "report"},
                                     {"study", "verify"},
                                     {"sweep", "status"}};

const std::vector<Words> with_input{
    {"demo", "--text", "INPUT", "-o", "FOLDER/out"},
    {"record", "--virtual", "--scene", "INPUT", "-o", "FOLDER/out.h5"},
    {"record", "--virtual", "--law", "INPUT", "-o", "FOLDER/out.h5"},
    {"record", "--virtual", "--law", "FOLDER/k.law.toml", "--switch", "INPUT@1", "-o", "FOLDER/out.h5"},
    {"record", "--sensor", "u6:0?calibration=INPUT", "-o", "FOLDER/out.h5"},
    {"import", "INPUT", "--map", "time=1[s],position=2[mm],force=3[N]", "-o", "FOLDER/out.h5"},
    {"import", "INPUT"},
    {"repair", "INPUT"},
    {"prepare", "INPUT", "--bias", "-o", "FOLDER/out.h5"},
    {"prepare", "FOLDER/r.h5", "--blank", "INPUT", "-o", "FOLDER/out.h5"},
    {"segment", "INPUT"},
    {"info", "INPUT"},
    {"info", "--follow", "INPUT"},
    {"inspect", "INPUT"},
    {"validate", "INPUT"},
    {"studio", "FOLDER/k.law.toml"},
    {"studio", "FOLDER/nowhere"},
    {"calibrate", "INPUT"},
    {"calibrate", "sim:sensor", "--loads", "INPUT", "-o", "FOLDER/out.calibration.toml"},
    {"law", "build", "INPUT", "-o", "FOLDER/out.so"},
    {"device", "build", "INPUT", "-o", "FOLDER/out.so"},
    {"fit", "INPUT", "-o", "FOLDER/out"},
    {"fit", "FOLDER/r.h5", "--plugin", "INPUT", "-o", "FOLDER/out"},
    {"fit", "FOLDER/r.h5", "INPUT", "-o", "FOLDER/out"},
    {"fit", "--batch", "FOLDER/nowhere", "-o", "FOLDER/out"},
    {"fit", "--batch", "FOLDER/k.law.toml", "-o", "FOLDER/out"},
    {"blade", "INPUT", "--shape", KERF_SOURCE_DIR "/examples/blade.law.toml"},
    {"blade", "FOLDER/r.h5", "--shape", "INPUT"},
    {"train", "INPUT", "-o", "FOLDER/out.law.toml"},
    {"choose", "INPUT"},
    {"choose", "--scene", "INPUT", "-o", "FOLDER/out"},
    {"check", "INPUT", "--virtual"},
    {"check", "--scene", "INPUT", "--virtual"},
    {"check", "FOLDER/k.law.toml", "--virtual", "--switch", "INPUT@1"},
    {"chart", "INPUT"},
    {"chart", "--scene", "INPUT"},
    {"stability", "INPUT"},
    {"stability", "--several", "INPUT"},
    {"identify", "--from", "INPUT"},
    {"replay", "INPUT", "--as", "table", "--virtual"},
    {"replay", "FOLDER/r.h5", "--through", "INPUT"},
    {"compare", "INPUT", "FOLDER/r.h5"},
    {"compare", "FOLDER/r.h5", "INPUT"},
    {"regress", "run", "INPUT"},
    {"regress", "trajectory", "INPUT", "case", "-o", "FOLDER/t.csv"},
    {"regress", "update", "INPUT", "--reason", "why", "--yes"},
    {"session", "new", "INPUT", "--subject", "S1", "--key-file", "FOLDER/key", "-o", "FOLDER/out.h5"},
    {"session", "new", "FOLDER/p.protocol.toml", "--no-check", "--subject", "S1", "--key-file", "INPUT", "-o",
     "FOLDER/out.h5"},
    {"session", "run", "INPUT", "--key-file", "FOLDER/key"},
    {"session", "run", "FOLDER/s.h5", "--key-file", "INPUT"},
    {"session", "analyze", "INPUT", "--key-file", "FOLDER/key"},
    {"session", "analyze", "INPUT.csv"},
    {"session", "open", "INPUT", "--key-file", "FOLDER/key", "-o", "FOLDER/out"},
    {"session", "open", "FOLDER/s.h5", "--key-file", "INPUT", "-o", "FOLDER/out"},
    {"session", "share", "INPUT", "--key-file", "FOLDER/key", "-o", "FOLDER/out"},
    {"session", "share", "FOLDER/s.h5", "--key-file", "INPUT", "-o", "FOLDER/out"},
    {"session", "simulate", "INPUT"},
    {"sweep", "plan", "INPUT"},
    {"sweep", "run", "INPUT"},
    {"sweep", "status", "INPUT"},
    {"sweep", "merge", "INPUT"},
    {"sweep", "submit", "INPUT", "--engine", "slurm"},
    {"session", "plan", "INPUT", "--participants", "2", "-o", "FOLDER/out"},
    {"session", "note", "INPUT", "a test", "--key-file", "FOLDER/key"},
    {"session", "drop", "INPUT", "S01", "--reason", "a test", "--key-file", "FOLDER/key"},
    {"session", "status", "INPUT", "--key-file", "FOLDER/key"},
    {"study", "new", "FOLDER/nowhere", "-o", "FOLDER/out"},
    {"study", "new", "FOLDER/k.law.toml", "-o", "FOLDER/out"},
    {"study", "run", "INPUT"},
    {"study", "report", "INPUT"},
    {"study", "verify", "FOLDER/nowhere"},
    {"report", "INPUT", "-o", "FOLDER/out.html"},
    {"convert", "INPUT", "-o", "FOLDER/out.csv"},
    {"export", "INPUT", "--as", "c", "-o", "FOLDER/out"},
    {"report", "FOLDER/r.h5", "INPUT", "-o", "FOLDER/out.html"},
    {"report", "FOLDER/r.h5", "--fits", "INPUT", "-o", "FOLDER/out.html"},
    {"report", "FOLDER/r.h5", "--check", "INPUT", "-o", "FOLDER/out.html"},
};

// OUTPUT is a file in a folder that does not exist, BELOW a folder that would have to be made in a file.
const std::vector<Words> with_output{
    {"demo", "-o", "BELOW"},
    {"record", "--virtual", "--seconds", "0.1", "-o", "OUTPUT"},
    {"import", "FOLDER/t.txt", "--map", "time=1[s],position=2[mm],force=3[N]", "-o", "OUTPUT"},
    {"repair", "FOLDER/open.h5", "-o", "OUTPUT"},
    {"prepare", "FOLDER/r.h5", "--from", "1", "-o", "OUTPUT"},
    {"prepare", "FOLDER/r.h5", "--filter", "butterworth2:20", "--filter-chart", "OUTPUT", "-o",
     "FOLDER/out.h5"},
    {"segment", "FOLDER/r.h5", "-o", "BELOW"},
    {"calibrate", KERF_SOURCE_DIR "/examples/calibration/cell.csv", "--map", "signal_1=3,fz=2[N],time=1[s]",
     "-o", "OUTPUT"},
    {"law", "new", "mylaw", "-o", "BELOW"},
    {"device", "new", "mydevice", "-o", "BELOW"},
    {"device", "build", KERF_SOURCE_DIR "/tests/drivers/hosted/moody.c", "-o", "BELOW.so"},
    {"law", "build", KERF_SOURCE_DIR "/tests/models/plugins/coulomb_spring.h", "-o", "BELOW.so"},
    {"fit", "FOLDER/r.h5", "-o", "BELOW"},
    {"blade", "FOLDER/blade.h5", "--shape", KERF_SOURCE_DIR "/examples/blade.law.toml", "-o", "BELOW"},
    {"train", "--example", "-o", "OUTPUT"},
    {"choose", "FOLDER/r.h5", "-o", "BELOW"},
    {"check", "FOLDER/k.law.toml", "--virtual", "--seconds", "0.1", "-o", "OUTPUT"},
    {"check", "FOLDER/k.law.toml", "--virtual", "--seconds", "0.1", "--record", "OUTPUT"},
    {"chart", "FOLDER/r.h5", "-o", "BELOW"},
    {"stability", "FOLDER/k.law.toml", "-o", "BELOW"},
    {"identify", "sim:axis?hand=off", "--seconds", "5", "-o", "BELOW"},
    {"reproduce", "Okamura2003", "-o", "BELOW"},
    {"replay", "FOLDER/r.h5", "--through", "FOLDER/z.law.toml", "-o", "BELOW"},
    {"compare", "FOLDER/r.h5", "FOLDER/r.h5", "-o", "BELOW"},
    {"regress", "run", KERF_SOURCE_DIR "/examples/regress/kerf.toml", "--only", "kelvin", "--no-cost",
     "--junit", "OUTPUT"},
    {"regress", "run", KERF_SOURCE_DIR "/examples/regress/kerf.toml", "--only", "kelvin", "--no-cost", "-o",
     "BELOW"},
    {"session", "key", "OUTPUT"},
    {"session", "new", "FOLDER/p.protocol.toml", "--no-check", "--subject", "S1", "--key-file", "FOLDER/key",
     "-o", "OUTPUT"},
    {"session", "plan", "FOLDER/p.protocol.toml", "--participants", "2", "-o", "BELOW"},
    {"session", "analyze", KERF_SOURCE_DIR "/examples/sessions/okamura2003-table-1.csv", "--bootstrap", "0",
     "-o", "BELOW"},
    {"session", "open", "FOLDER/s.h5", "--key-file", "FOLDER/key", "--reason", "a test", "-o", "BELOW"},
    {"session", "share", "FOLDER/s.h5", "--key-file", "FOLDER/key", "--reason", "a test", "-o", "BELOW"},
    {"session", "simulate", "FOLDER/p.protocol.toml", "-o", "BELOW"},
    {"study", "new", KERF_SOURCE_DIR "/examples/data", "-o", "BELOW"},
    {"sweep", "plan", "FOLDER/w.toml", "--no-sample", "-o", "OUTPUT"},
    {"sweep", "run", "FOLDER/w.plan.json", "-o", "BELOW"},
    {"sweep", "merge", "FOLDER/w.plan.json", "-o", "BELOW"},
    {"sweep", "submit", "FOLDER/w.plan.json", "--engine", "slurm", "-o", "OUTPUT"},
    {"report", "FOLDER/r.h5", "-o", "OUTPUT"},
    {"convert", "FOLDER/r.h5", "-o", "OUTPUT.csv"},
    {"convert", "FOLDER/r.h5", "-o", "OUTPUT.mat"},
    {"convert", "FOLDER/r.h5", "-o", "OUTPUT.mcap"},
    {"export", "FOLDER/k.law.toml", "--as", "c", "-o", "BELOW"},
};

constexpr const char* law_along_z = R"(model = "kelvin"
axis = "z"
position_unit = "m"
contact = { position = { value = 0, unit = "m" }, direction = "increasing" }
[parameters]
parallel_stiffness = { value = 300, unit = "N/m" }
series_stiffness = { value = 500, unit = "N/m" }
damping = { value = 50, unit = "N·s/m" }
)";

class ExitStatus : public testing::Test {
 protected:
  ExitStatus() {
    schema::write_recording(folder_ / "r.h5", test::punch());
    leave_open();
    test::write_text(folder_ / "k.law.toml", test::kelvin_law);
    test::write_text(folder_ / "z.law.toml", law_along_z);
    test::write_text(folder_ / "t.txt", "0,1,2\n1,2,3\n2,3,4\n");
    for (const char* law : {"soft.law.toml", "stiff.law.toml", "third.law.toml", "still.law.toml"})
      test::write_text(folder_ / law, test::law_called(law));
    test::write_text(folder_ / "p.protocol.toml",
                     test::protocol_text("design = \"abx\"\ntrials = 4\ndevice = \"sim:scissors\"\n"));
    test::write_text(folder_ / "w.toml",
                     "version = 1\nverb = \"stability\"\n[cells]\nmass = 1\nstiffness = 1\n");
    EXPECT_EQ(run_kerf({"sweep", "plan", (folder_ / "w.toml").string(), "--no-sample"}).exit_status, 0);
    EXPECT_EQ(run_kerf({"session", "key", (folder_ / "key").string()}).exit_status, 0);
    EXPECT_EQ(run_kerf(filled_in({"session", "new", "FOLDER/p.protocol.toml", "--no-check", "--subject", "S1",
                                  "--key-file", "FOLDER/key", "-o", "FOLDER/s.h5"},
                                 {}))
                  .exit_status,
              0);
  }

  /// open.h5.partial, as a crash leaves it.
  void leave_open() const {
    schema::RecordingWriter writer(folder_ / "written.h5", schema::new_header("kerf test"), {schema::Axis{}},
                                   {});
    writer.append(std::vector<schema::Row>{{.tick = 0, .time_s = 0.0}, {.tick = 1, .time_s = 0.001}});
    writer.flush();
    fs::copy_file(writer.path(), folder_ / "open.h5.partial");
  }

  /// The words with files of the folder, and `wrong` in place of INPUT and the like.
  [[nodiscard]] Words filled_in(Words words, const std::map<std::string, std::string>& wrong) const {
    for (std::string& word : words) {
      for (const auto& [name, file] : wrong) {
        if (const auto at = word.find(name); at != std::string::npos) word.replace(at, name.size(), file);
      }
      if (word.starts_with("FOLDER/")) word = (folder_ / word.substr(7)).string();
    }
    return words;
  }

  /// One line about `file`, and nothing written.
  void expect_failure(const Words& words, int status, const std::string& file) const {
    const Outcome outcome = run_kerf(words);
    std::string all;
    for (const std::string& word : words) all += word + " ";
    EXPECT_EQ(outcome.exit_status, status) << all << '\n' << outcome.errors;
    EXPECT_THAT(outcome.errors, testing::HasSubstr("kerf: ")) << all;
    EXPECT_THAT(outcome.errors, testing::HasSubstr(file)) << all;
    for (const auto& entry : fs::directory_iterator(folder_.path()))
      EXPECT_FALSE(entry.path().filename().string().starts_with("out")) << all << "left " << entry.path();
  }
  void expect_bad_input(const std::string& name) const {
    for (const Words& command : with_input)
      expect_failure(filled_in(command, {{"INPUT", (folder_ / name).string()}}), 2, "");
  }

  test::TemporaryFolder folder_;
};

/// Verbs that no command of the list begins with.
std::set<Words> missing_from(const std::vector<Words>& commands, const std::set<Words>& without) {
  std::set<Words> missing;
  for (const Words& verb : test::all_verbs()) {
    const auto begins = [&](const Words& command) {
      return std::equal(verb.begin(), verb.end(), command.begin(),
                        command.begin() + static_cast<std::ptrdiff_t>(std::min(verb.size(), command.size())));
    };
    if (!without.contains(verb) && std::ranges::none_of(commands, begins)) missing.insert(verb);
  }
  return missing;
}

TEST_F(ExitStatus, TheListsHoldEveryVerb) {
  EXPECT_THAT(missing_from(with_input, without_input), testing::IsEmpty());
  EXPECT_THAT(missing_from(with_output, without_output), testing::IsEmpty());
}

TEST_F(ExitStatus, AMissingInputIsBadInput) { expect_bad_input("none"); }

TEST_F(ExitStatus, AFolderInPlaceOfAFileIsBadInput) {
  fs::create_directory(folder_ / "folder");
  fs::create_directory(folder_ / "folder.csv");
  expect_bad_input("folder");
}

TEST_F(ExitStatus, AnInputThatCannotBeOpenedIsBadInput) {
  for (const char* name : {"loop", "loop.csv"}) fs::create_symlink(name, folder_ / name);
  expect_bad_input("loop");
}

TEST_F(ExitStatus, AnOutputThatCannotBeWrittenIsAFailureToWrite) {
  const std::string output = (folder_ / "nowhere" / "x").string();
  const std::string below = (folder_ / "k.law.toml" / "x").string();
  for (const Words& command : with_output)
    expect_failure(filled_in(command, {{"OUTPUT", output}, {"BELOW", below}}), 4, "/x");
}

TEST_F(ExitStatus, AnOutputThatExistsIsBadInput) {
  expect_failure(filled_in({"prepare", "FOLDER/r.h5", "--from", "1", "-o", "FOLDER/t.txt"}, {}), 2,
                 "--force");
  test::write_text(folder_ / "t.dictionary.csv", "mine\n");
  expect_failure(filled_in({"convert", "FOLDER/r.h5", "-o", "FOLDER/t.csv"}, {}), 2, "t.dictionary.csv");
}

TEST_F(ExitStatus, AnOutputOfAnUnknownFormatIsBadInput) {
  expect_failure(filled_in({"convert", "FOLDER/r.h5", "-o", "FOLDER/out.xlsx"}, {}), 2, "'.xlsx'");
}

TEST_F(ExitStatus, ADeviceThatIsNotThereIsADeviceError) {
  expect_failure(filled_in({"record", "--device", "sim:nothing", "-o", "FOLDER/out.h5"}, {}), 3,
                 "sim:nothing");
}

TEST_F(ExitStatus, ACheckThatDidNotPassIsOne) {
  test::write_text(folder_ / "bad.h5", "no HDF5\n");
  EXPECT_EQ(run_kerf(filled_in({"info", "FOLDER/bad.h5"}, {})).exit_status, 2);
  schema::Recording recording = test::punch();
  recording.tick[7] = recording.tick[6];
  schema::write_recording(folder_ / "bad.h5", recording);
  const Outcome outcome = run_kerf(filled_in({"validate", "FOLDER/bad.h5"}, {}));
  EXPECT_EQ(outcome.exit_status, 1) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
}

}  // namespace
}  // namespace kerf
