// The MEX source is built by Debian's Octave and called there.

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/export/example_export.h"
#include "exported_law.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

class Octave : public testing::Test {
 protected:
  void SetUp() override {
    if (test::run({"/usr/bin/env", "mkoctfile", "--version"}).exit_status != 0 ||
        test::run({"/usr/bin/env", "octave-cli", "--version"}).exit_status != 0)
      GTEST_SKIP() << "no octave-cli and mkoctfile";
    test::write_files(octave_host().files(test::liver()), folder_.path());
  }
  /// With what octave-cli is started with, in the folder of the export.
  [[nodiscard]] test::Outcome octave(const std::string& commands) const {
    return test::run({"/usr/bin/env", "-C", folder_.path().string(), "octave-cli", "--no-init-file",
                      "--no-history", "--quiet", "--eval", commands});
  }
  test::TemporaryFolder folder_;
};

TEST_F(Octave, CallsTheLawAsItsHelpSaysAndRefusesWhatIsNone) {
  // The line of the help that builds it, as a reader takes it.
  const std::string help = test::read_text(folder_ / "liver.m");
  const auto line = help.find("CFLAGS=");
  const std::string build = help.substr(line, help.find("     (", line) - line);
  const auto built = test::run({"/bin/sh", "-c", "cd '" + folder_.path().string() + "' && " + build});
  ASSERT_EQ(built.exit_status, 0) << build << built.output << built.errors;
  const auto outcome = octave("addpath('" KERF_SOURCE_DIR "/tests/bench/export'); check_octave()");
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
  const auto shown = octave("help liver");
  EXPECT_THAT(shown.output, HasSubstr("the law kelvin, for the axis theta"));
  EXPECT_THAT(shown.output, HasSubstr("POSITION [rad]"));
}

TEST_F(Octave, SaysHowToBuildItWhereItIsNotBuilt) {
  const auto outcome = octave("liver(1, 2, 3)");
  EXPECT_NE(outcome.exit_status, 0);
  EXPECT_THAT(outcome.errors, HasSubstr("liver is not built; its help says how"));
}

TEST_F(Octave, GivesTheForcesOfTheLawToTheBit) {
  std::vector<HostSample> samples = test::wandering(2000);
  samples[1000].position = std::nan("");
  samples[1500].elapsed_s = -1.0;
  EXPECT_THAT(test::differing(octave_host().forces(test::liver(), folder_.path(), samples),
                              test::forces_of_liver(samples)),
              IsEmpty());
}

TEST(OctaveExport, TakesNoWordOfOctave) {
  ExportedLaw law = test::liver();
  law.name = "end";
  EXPECT_THAT([&] { static_cast<void>(octave_host().files(law)); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("'end' is a word of Octave itself; give the law file another name")));
}

TEST(OctaveExport, KeepsWhatALawFileSaysWithinItsLine) {
  ExportedLaw law = test::liver();
  law.file.axis = "a\n\"\"\"\\b";
  const std::vector<HostFile> files = octave_host().files(law);
  EXPECT_THAT(files.back().content, HasSubstr("for the axis a '''/b"));
}

}  // namespace
}  // namespace kerf::bench
