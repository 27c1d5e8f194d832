// The module is used by Debian's Python.

#include <cmath>
#include <filesystem>
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

class PythonModule : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(debians_python)) GTEST_SKIP() << "no " << debians_python;
    test::write_files(python_host().files(test::liver()), folder_.path());
  }
  // Debian's own, as its packages are not seen by others.
  static constexpr auto debians_python = "/usr/bin/python3";
  test::TemporaryFolder folder_;
};

TEST_F(PythonModule, IsTheLawWithAndWithoutNumPyAndRefusesWhatIsNone) {
  const auto outcome = test::run(
      {debians_python, "-B", KERF_SOURCE_DIR "/tests/bench/export/check_python.py", folder_.path().string()});
  if (outcome.exit_status == 77) GTEST_SKIP() << outcome.output;
  EXPECT_EQ(outcome.exit_status, 0) << outcome.output << outcome.errors;
}

TEST_F(PythonModule, GivesTheForcesOfTheLawToTheBit) {
  std::vector<HostSample> samples = test::wandering(2000);
  samples[1000].position = std::nan("");
  samples[1500].elapsed_s = -1.0;
  EXPECT_THAT(test::differing(python_host().forces(test::liver(), folder_.path(), samples),
                              test::forces_of_liver(samples)),
              IsEmpty());
}

TEST(PythonExport, TakesNoWordOfPython) {
  ExportedLaw law = test::liver();
  law.name = "lambda";
  EXPECT_THAT([&] { static_cast<void>(python_host().files(law)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'lambda' is a word of Python itself")));
}

TEST(PythonExport, KeepsWhatALawFileSaysWithinItsLine) {
  ExportedLaw law = test::liver();
  law.file.axis = "a\n\"\"\"\\b";
  const std::vector<HostFile> files = python_host().files(law);
  EXPECT_THAT(files.back().content, HasSubstr("for the axis a '''/b"));
}

}  // namespace
}  // namespace kerf::bench
