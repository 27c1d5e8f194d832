// Inputs that hang or have no end: every verb that reads a text refuses them, at once and in one line.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <kerf/schema/recording.h>

#include "support/kelvin_law.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf {
namespace {

using test::run_kerf;
using testing::HasSubstr;

class OddInput : public testing::Test {
 protected:
  OddInput() {
    test::write_text(law(), test::kelvin_law);
    if (mkfifo(fifo().c_str(), 0600) != 0) throw std::runtime_error("no FIFO");
    test::write_text(huge(), "# ");
    std::filesystem::resize_file(huge(), (std::uintmax_t{16} << 20U) + 1);
  }
  [[nodiscard]] std::string law() const { return (folder_ / "k.law.toml").string(); }
  [[nodiscard]] std::string fifo() const { return (folder_ / "fifo").string(); }
  [[nodiscard]] std::string huge() const { return (folder_ / "huge.toml").string(); }
  [[nodiscard]] std::string output() const { return (folder_ / "output").string(); }

  /// Every verb that takes the name of a text, with this one.
  [[nodiscard]] std::vector<std::vector<std::string>> readers_of(const std::string& file) const {
    return {{"check", file, "--virtual"},
            {"check", law(), "--virtual", "--scene", file},
            {"record", "--virtual", "--law", file, "-o", output()},
            {"regress", "run", file},
            {"session", "new", file, "--subject", "a", "-o", output()},
            {"session", "simulate", file}};
  }
  static void expect_refusal(const std::vector<std::string>& words, const std::string& message) {
    const test::Outcome outcome = run_kerf(words);
    EXPECT_EQ(outcome.exit_status, 2) << words[0];
    EXPECT_THAT(outcome.errors, HasSubstr(message)) << words[0];
  }

  test::TemporaryFolder folder_;
};

TEST_F(OddInput, IsRefusedWhereItIsADevice) {
  for (const auto& words : readers_of("/dev/zero"))
    expect_refusal(words, "/dev/zero: a device; expected a regular file\n");
  expect_refusal({"train", "/dev/zero", "-o", output()}, "/dev/zero: a device;");
  expect_refusal({"import", "/dev/zero", "--map", "position=1[mm]", "-o", output()}, "/dev/zero: a device;");
  expect_refusal({"record", "--seconds", "0.1", "--sensor", "u6:0?calibration=/dev/zero", "-o", output()},
                 "/dev/zero: the force calibration cannot be read (not a regular file)");
}

TEST_F(OddInput, IsRefusedWhereItIsAFifoThatNobodyWritesTo) {
  for (const auto& words : readers_of(fifo())) expect_refusal(words, fifo() + ": a FIFO; expected");
  expect_refusal({"train", fifo(), "-o", output()}, ": a FIFO;");
  expect_refusal({"import", fifo(), "--map", "position=1[mm]", "-o", output()}, ": a FIFO;");
  expect_refusal({"record", "--seconds", "0.1", "--sensor", "u6:0?calibration=" + fifo(), "-o", output()},
                 "cannot be read (not a regular file)");
}

TEST_F(OddInput, IsRefusedWhereItIsTooLarge) {
  for (const auto& words : readers_of(huge()))
    expect_refusal(words, huge() + ": 16777217 bytes; expected 16 MiB at most\n");
  test::write_text(folder_ / "t.txt", "0,1\n1,2\n");
  const std::vector<std::string> import{
      "import", (folder_ / "t.txt").string(), "--map", "time=1[s],position=2[mm]", "-o", output()};
  auto limited = import;
  limited.insert(limited.end(), {"--max-bytes", "7"});
  expect_refusal(limited, "t.txt: 8 bytes; expected 7 bytes at most");
  EXPECT_EQ(run_kerf(import).exit_status, 0);
}

TEST_F(OddInput, IsReadFromAPipeThatIsMeant) {
  const auto shell = [&](const std::string& command) { return test::run({"/bin/bash", "-c", command}); };
  const std::string kerf = KERF_PROGRAM;
  const auto imported =
      shell("printf '0,1\n1,2\n' | " + kerf + " import - --map time=1[s],position=2[mm] -o " + output());
  EXPECT_EQ(imported.exit_status, 0) << imported.errors;
  EXPECT_THAT(imported.output, HasSubstr("2 samples"));
  const auto checked = shell(kerf + " check <(cat " + law() + ") --virtual --seconds 0.2");
  EXPECT_LE(checked.exit_status, 1) << checked.errors;
  EXPECT_THAT(checked.output, HasSubstr("200 ticks"));
}

TEST_F(OddInput, SteersNoTerminal) {
  const std::string clear = "\x1b[2J\u009B2J\u202E";
  schema::Recording recording = test::punch();
  recording.header.source = clear;
  recording.header.history = clear;
  recording.channels.push_back(
      {.name = clear, .unit = "1", .values = std::vector<double>(recording.rows(), 0.0)});
  recording.events.push_back({.time_s = 0.0, .kind = "note", .text = clear});
  const std::string file = (folder_ / ("a" + clear + ".h5")).string();
  schema::write_recording(file, recording);
  test::write_text(folder_ / "clear.toml", R"(model = "\u001b[2J\u009b2J\u202e")");
  const std::vector<std::vector<std::string>> commands{{"info", file},
                                                       {"info", file, "--json"},
                                                       {"validate", file},
                                                       {"validate", (folder_ / clear).string()},
                                                       {"check", (folder_ / "clear.toml").string()},
                                                       {clear},
                                                       {"laws", clear},
                                                       {"info", file, "--" + clear},
                                                       {"record", "--device", clear, "-o", output()}};
  for (const auto& words : commands) {
    const test::Outcome outcome = run_kerf(words);
    const std::string said = outcome.output + outcome.errors;
    EXPECT_THAT(said, HasSubstr("\\u001b[2J\\u009b2J\\u202e")) << words[0];
    for (const char* steering : {"\x1b", "\u009B", "\u202E"})
      EXPECT_THAT(said, testing::Not(HasSubstr(steering))) << words[0];
  }
}

}  // namespace
}  // namespace kerf
