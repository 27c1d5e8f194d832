#include "support/program.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::test {
namespace {

using testing::HasSubstr;

TEST(KerfFit, ReplacesNoLawFileThatSomebodyMayHaveEdited) {
  const TemporaryFolder folder;
  const std::string cut = folder / "cut.h5";
  const std::string fits = folder / "fits";
  ASSERT_EQ(run_kerf({"record", "--virtual", "--seconds", "6", "-o", cut}).exit_status, 0);
  std::filesystem::create_directory(fits);
  write_text(folder / "fits/kelvin.law.toml", "mine");

  const Outcome refused = run_kerf({"fit", cut, "--models", "kelvin", "-o", fits});
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("kelvin.law.toml exists; --force replaces it"));
  EXPECT_EQ(read_text(folder / "fits/kelvin.law.toml"), "mine");

  EXPECT_EQ(run_kerf({"fit", cut, "--models", "exponential", "-o", fits}).exit_status, 0)
      << "a law that it does not write is not in its way";
  EXPECT_EQ(run_kerf({"fit", cut, "--models", "kelvin", "-o", fits, "--force"}).exit_status, 0);
  EXPECT_THAT(read_text(folder / "fits/kelvin.law.toml"), HasSubstr("model = \"kelvin\""));
}

// --force replaces what an earlier run has written, and never what this one reads.
TEST(KerfForce, ReplacesNothingThatIsRead) {
  const TemporaryFolder folder;
  const std::string cut = folder / "rr/kelvin.h5";
  std::filesystem::create_directory(folder.path() / "rr");
  ASSERT_EQ(run_kerf({"record", "--virtual", "--seconds", "3", "-o", cut}).exit_status, 0);
  ASSERT_EQ(run_kerf({"fit", cut, "--models", "kelvin", "-o", folder / "fits"}).exit_status, 0);
  const std::string before = read_text(cut);
  const std::string law = folder / "fits/kelvin.law.toml";
  const Outcome replay = run_kerf({"replay", cut, "--through", law, "-o", folder / "rr", "--force"});
  EXPECT_EQ(replay.exit_status, 2) << replay.errors;
  EXPECT_THAT(replay.errors, HasSubstr("kelvin.h5: the output would take the place of what is read for it"));
  EXPECT_EQ(read_text(cut), before);

  std::string table = "t_s,U,Load\n";
  for (int i = 0; i < 40; ++i) table += fmt::format("{},{},{}\n", 0.1 * i, 0.01 * i, 0.1 * i);
  write_text(folder / "cell.csv", table);
  const Outcome calibrated =
      run_kerf({"calibrate", folder / "cell.csv", "--map", "signal_1=U[mV],fz=Load[N],time=t_s[s]",
                "--tolerance", "0.001", "-o", folder / "cell.calibration.toml", "--force"});
  EXPECT_EQ(calibrated.exit_status, 2) << calibrated.errors;
  EXPECT_THAT(calibrated.errors, HasSubstr("give another name"));
  EXPECT_EQ(read_text(folder / "cell.csv"), table);
}

}  // namespace
}  // namespace kerf::test
