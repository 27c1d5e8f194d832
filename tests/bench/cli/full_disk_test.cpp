#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/disks/small_disk.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// Verbs whose results go to a disk of 256 KiB.
class FullDiskBeforeTheWork : public testing::Test {
 protected:
  FullDiskBeforeTheWork() {
    fs::create_directory(folder_ / "disk");
    fs::create_directory(folder_ / "drawer");
    schema::write_recording(folder_ / "cut.h5", test::punch());
    const schema::Recording cut = test::punch({.seconds = 6.0});
    std::string text = "Time [s]\tPosition [mm]\tForce [N]\n";
    for (std::size_t i = 0; i < cut.rows(); ++i)
      text += std::to_string(cut.time[i]) + "\t" + std::to_string(1e3 * cut.position[i]) + "\t" +
              std::to_string(cut.force_measured[i]) + "\n";
    test::write_text(folder_ / "drawer/liver.txt", text);
  }
  test::Outcome run(const std::string& script) const {
    const std::string kerf =
        "kerf() { '" KERF_PROGRAM "' \"$@\"; }; cd '" + folder_.path().string() + "' && ";
    return test::run_on_small_disk((folder_ / "disk").string(), 256 << 10U, kerf + script);
  }
  test::TemporaryFolder folder_;
};

TEST_F(FullDiskBeforeTheWork, IsFoundAndNothingIsLeft) {
  if (!test::can_have_small_disk()) GTEST_SKIP() << "no right to mount a disk";
  for (const std::string verb :
       {"fit cut.h5 --models kelvin -o disk/fits", "choose cut.h5 --no-loop -o disk/choice",
        "chart cut.h5 -o disk/chart", "fit --batch . -o disk/batch"}) {
    const test::Outcome ran = run("kerf " + verb + "; status=$?; ls -A disk; exit $status");
    EXPECT_EQ(ran.exit_status, 4) << verb << ran.errors;
    EXPECT_THAT(ran.errors,
                testing::ContainsRegex(
                    "needs about [12].0 MiB of the disk for .+, and 0.2 MiB can be had: No space left on "
                    "device\n$"))
        << verb;
    EXPECT_EQ(ran.output, "") << verb;
  }
}

TEST_F(FullDiskBeforeTheWork, IsFoundByAStudy) {
  if (!test::can_have_small_disk()) GTEST_SKIP() << "no right to mount a disk";
  const test::Outcome ran =
      run("kerf study new drawer -o disk/S >/dev/null; kerf study run disk/S/study.toml; status=$?; ls -A "
          "disk/S; exit "
          "$status");
  EXPECT_EQ(ran.exit_status, 4) << ran.errors;
  EXPECT_THAT(ran.errors, testing::AllOf(HasSubstr("needs about"), HasSubstr("for a study of 1 files")));
  EXPECT_EQ(ran.output, "study.toml\n");
}

}  // namespace
}  // namespace kerf::bench
