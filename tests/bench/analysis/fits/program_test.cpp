#include "support/program.h"

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

}  // namespace
}  // namespace kerf::test
