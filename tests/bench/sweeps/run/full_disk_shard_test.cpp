// A disk that is full ends a run, which goes on when there is room again.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"
#include "support/disks/small_disk.h"

namespace kerf::bench {
namespace {

using FullDiskUnderAShard = test::SweepFolder;

TEST_F(FullDiskUnderAShard, EndsItWithALineAndItGoesOnWithRoom) {
  if (!test::can_have_small_disk()) GTEST_SKIP() << "no right to mount a disk";
  std::filesystem::create_directory(file("disk"));
  (void)plan_of(
      "version = 1\nverb = \"stability\"\n[cells]\nmass = { from = 0.1, to = 0.2, count = 400 }\nseconds = "
      "0.01\n"
      "stiffness = 100\n");
  const std::string run = "'" KERF_PROGRAM "' sweep run '" + file("w.plan.json").string() + "' -j 1 -o '" +
                          file("disk/s").string() + "'";
  const test::Outcome ran = test::run_on_small_disk(
      file("disk").string(), 64 << 10U,
      "cd '" + file("disk").string() + "'; head -c 40960 /dev/zero > filler; " + run +
          "; echo status $?; rm filler; " + run + " >/dev/null; echo status $?; ls -A s");
  EXPECT_THAT(ran.output, testing::HasSubstr("status 4\nstatus 0\n0-of-1.shard\n")) << ran.errors;
  EXPECT_THAT(ran.errors, testing::HasSubstr("No space left on device"));
}

}  // namespace
}  // namespace kerf::bench
