// A process that may take little memory says what it was needed for. Left out under sanitizers, which take
// terabytes.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class MemoryLimit : public testing::Test {
 protected:
  /// Runs `kerf` where it may take so much.
  static test::Outcome run_within(int megabytes, const std::string& words) {
    return test::run(
        {"/bin/sh", "-c",
         "ulimit -v " + std::to_string(megabytes * 1024) + " && exec " KERF_PROGRAM " " + words});
  }
  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  test::TemporaryFolder folder_;
};

TEST_F(MemoryLimit, OfAnImportIsToldBeforeTheWork) {
  std::string text;
  for (int i = 0; i < 3'000'000; ++i) text += std::to_string(i) + ",1\n";
  test::write_text(at("t.txt"), text);
  const std::string import = "import " + at("t.txt") + " --map time=1[s],position=2[mm] -o " + at("r.h5");
  const auto refused = run_within(150, import);
  EXPECT_EQ(refused.exit_status, 4);
  EXPECT_THAT(refused.errors,
              ContainsRegex("t.txt: needs 0.1[0-9] GiB of memory for about [0-9]+ rows, and 0.[0-9]+ GiB can "
                            "be had: Cannot allocate memory\n$"));
  EXPECT_FALSE(std::filesystem::exists(at("r.h5")));
  EXPECT_EQ(run_within(600, import).exit_status, 0);
}

TEST_F(MemoryLimit, OfATextIsToldBeforeItIsRead) {
  test::write_text(at("t.csv"), "");
  std::filesystem::resize_file(at("t.csv"), std::uintmax_t{250} << 20U);
  const auto refused = run_within(200, "train " + at("t.csv") + " -o " + at("o"));
  EXPECT_EQ(refused.exit_status, 4);
  EXPECT_THAT(refused.errors, HasSubstr("t.csv: needs 0.24 GiB of memory for its text, and "));
}

TEST_F(MemoryLimit, ThatIsMetHalfWayNamesVerbAndFile) {
  test::write_text(at("t.csv"), "");
  std::filesystem::resize_file(at("t.csv"), std::uintmax_t{200} << 20U);
  const auto ended = run_within(350, "train " + at("t.csv") + " -o " + at("o"));
  EXPECT_EQ(ended.exit_status, 4);
  EXPECT_EQ(ended.errors,
            "kerf: there was not enough memory for 'train " + at("t.csv") + " -o " + at("o") + "'\n");
}

}  // namespace
}  // namespace kerf
