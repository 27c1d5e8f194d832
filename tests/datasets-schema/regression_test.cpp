#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/regression.h>
#include <kerf/schema/validate.h>

#include "datasets-schema/recording/sample_recording.h"
#include "hdf5/h5.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::ThrowsMessage;

StoredForces sample_forces() {
  StoredForces one{.name = "a blade, slowly",
                   .model = "blade",
                   .law_sha256 = "12ab",
                   .trajectory_sha256 = "34cd",
                   .reason = "first forces",
                   .date = "2026-01-31T12:00:00Z",
                   .software = "kerf 0.1.0",
                   .history = "2026-01-30T12:00:00Z kerf 0.1.0: too stiff\n",
                   .channels = {{"x", "N"}, {"rx", "N·m"}},
                   .force = {},
                   .faults = 3,
                   .tick_cost = 1.25,
                   .tick_cost_build = "optimised"};
  for (int i = 0; i < 20000; ++i) one.force.push_back(std::sin(0.01 * i) / 3.0);
  return one;
}

class Regression : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "suite.h5";
};

TEST_F(Regression, KeepsWhatARendererTookAndWhatItWas) {
  StoredForces one{.name = "outside", .renderer = "./mysim", .channels = {{"x", "N"}}, .force = {1.0, 2.0}};
  one.compute_time_s = {3e-5, 0.1 + 0.2};
  one.compute_time_of = "round trip";
  one.made_with = "version: mysim 1.0\nmysim: 12ab\n";
  write_regression(file_, {one});
  EXPECT_THAT(validate(file_), IsEmpty());
  const auto all = read_regression(file_);
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(all[0].compute_time_s, one.compute_time_s);
  EXPECT_EQ(all[0].compute_time_of, "round trip");
  EXPECT_EQ(all[0].made_with, one.made_with);
  one.compute_time_s.push_back(1.0);
  EXPECT_THAT([&] { write_regression(file_, {one}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("compute times for another number of rows")));
}

TEST_F(Regression, ComesBackBitForBit) {
  StoredForces odd{.name = "odd", .channels = {{"theta", "N"}}};
  odd.force = {-0.0, std::numeric_limits<double>::denorm_min(), 0.1 + 0.2};
  write_regression(file_, {sample_forces(), odd});
  const auto all = read_regression(file_);
  ASSERT_THAT(all, SizeIs(2));
  const StoredForces expected = sample_forces();
  EXPECT_EQ(all[0].name, expected.name);
  EXPECT_EQ(all[0].model, expected.model);
  EXPECT_EQ(all[0].law_sha256, expected.law_sha256);
  EXPECT_EQ(all[0].trajectory_sha256, expected.trajectory_sha256);
  EXPECT_EQ(all[0].reason, expected.reason);
  EXPECT_EQ(all[0].date, expected.date);
  EXPECT_EQ(all[0].software, expected.software);
  EXPECT_EQ(all[0].history, expected.history);
  EXPECT_EQ(all[0].faults, 3U);
  EXPECT_EQ(all[0].tick_cost, 1.25);
  EXPECT_EQ(all[0].tick_cost_build, "optimised");
  ASSERT_THAT(all[0].channels, SizeIs(2));
  EXPECT_EQ(all[0].channels[1].name, "rx");
  EXPECT_EQ(all[0].channels[1].unit, "N·m");
  EXPECT_EQ(all[0].force, expected.force);
  EXPECT_EQ(all[0].rows(), 10000U);
  EXPECT_EQ(all[1].force, odd.force);
  EXPECT_TRUE(std::signbit(all[1].force[0]));
  EXPECT_FALSE(all[1].tick_cost);
}

TEST_F(Regression, ComesBackHoweverManyPiecesItIsReadIn) {
  StoredForces hour = sample_forces();
  hour.name = "an hour";
  for (int i = 0; i < 600'000; ++i) hour.force.push_back(0.5 * i);
  write_regression(file_, {sample_forces(), hour});
  const auto all = read_regression(file_);
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_TRUE(all[1].force == hour.force);
}

// The first file that `kerf regress update` ever wrote into the tree; the numbers are h5py's.
TEST_F(Regression, OfTheFirstKerfIsStillRead) {
  const std::filesystem::path first = KERF_SOURCE_DIR "/tests/datasets-schema/golden/regression-1-first.h5";
  const auto all = read_regression(first);
  ASSERT_THAT(all, SizeIs(19));
  EXPECT_EQ(all[0].name, "kelvin");
  EXPECT_EQ(all[0].force[300], 5.1442130968440605);
  EXPECT_EQ(all[0].date, "2026-11-21T21:47:56Z");
  EXPECT_EQ(all[0].tick_cost, 0.6922336720618948);
  EXPECT_TRUE(all[0].trajectory.empty());
  const auto blade = std::ranges::find(all, std::string("blade"), &StoredForces::name);
  ASSERT_THAT(blade->channels, SizeIs(6));
  EXPECT_EQ(blade->force[300 * 6], -0.05518008185774805);
  EXPECT_THAT(validate(first), IsEmpty());
}

TEST_F(Regression, KeepsATrajectoryOnceForAllItsCases) {
  StoredForces one = sample_forces();
  one.trajectory = {
      .axes = {{"x", "m"}, {"rx", "rad"}}, .time_s = {0.0, 0.001}, .position = {0.1, 0.2, 0.3, 0.4}};
  StoredForces again = one;
  again.name = "the same way";
  write_regression(file_, {one, again});
  const auto all = read_regression(file_);
  EXPECT_EQ(all[0], one);
  EXPECT_EQ(all[1].trajectory, one.trajectory);
  EXPECT_THAT(validate(file_), IsEmpty());
  again.trajectory.position.pop_back();
  EXPECT_THAT([&] { write_regression(file_, {again}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("does not fill its rows")));
}

TEST_F(Regression, IsCompressed) {
  StoredForces quiet{.name = "quiet", .channels = {{"theta", "N"}}};
  quiet.force.assign(100000, 0.0);
  write_regression(file_, {quiet});
  EXPECT_LT(std::filesystem::file_size(file_), 30000U) << "800 kB as they are";
}

TEST_F(Regression, LeavesTheOldFileAloneWhenItCannotBeWritten) {
  write_regression(file_, {sample_forces()});
  StoredForces twice = sample_forces();
  EXPECT_THAT(
      [&] {
        write_regression(file_, {twice, twice});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("two cases named 'a blade, slowly'")));
  twice.name = "a/b";
  EXPECT_THAT([&] { write_regression(file_, {twice}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'a/b' is no name")));
  twice.name = "c";
  twice.force.pop_back();
  EXPECT_THAT([&] { write_regression(file_, {twice}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("19999 numbers for 2 channels")));
  EXPECT_EQ(read_regression(file_).front().name, "a blade, slowly");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << "nothing beside it";
}

TEST_F(Regression, RefusesWhatIsNoneInOneLine) {
  EXPECT_THAT(
      [&] { (void)read_regression(file_); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("there is no such file; expected stored forces")));
  test::write_text(file_, "name = 1\n");
  EXPECT_THAT([&] { (void)read_regression(file_); },
              ThrowsMessage<FormatError>(HasSubstr("not an HDF5 file")));
  write_recording(file_, test::sample_recording());
  EXPECT_THAT(
      [&] { (void)read_regression(file_); },
      ThrowsMessage<FormatError>(HasSubstr("found the schema 'kerf.recording', expected stored forces")));
}

TEST_F(Regression, RefusesAnotherVersion) {
  write_regression(file_, {sample_forces()});
  {
    auto file = h5::WritableFile::open(file_);
    const auto root = h5::open(file.id(), "/");
    h5::delete_attribute(root.id(), "schema_version");
    const std::uint32_t later = 2;
    h5::write_attribute(root.id(), "schema_version", h5::native<std::uint32_t>(), {}, &later);
  }
  EXPECT_THAT([&] { (void)read_regression(file_); },
              ThrowsMessage<FormatError>(HasSubstr("found version 2 of kerf.regression, expected 1")));
}

TEST_F(Regression, RefusesACutFile) {
  write_regression(file_, {sample_forces()});
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  EXPECT_THROW((void)read_regression(file_), FormatError);
}

TEST_F(Regression, RefusesMoreForcesThanTheFileCanHold) {
  write_regression(file_, {sample_forces()});
  {
    auto file = h5::WritableFile::open(file_);
    const h5::Extent absurd{1'000'000'000'000, 2};
    h5::call(H5Dset_extent, h5::open(file.id(), "/cases/a blade, slowly/force").id(), absurd.data());
  }
  EXPECT_THAT([&] { (void)read_regression(file_); },
              ThrowsMessage<FormatError>(HasSubstr("found more values than the file can hold")));
}

TEST_F(Regression, IsValidAsItWasWritten) {
  write_regression(file_, {sample_forces()});
  EXPECT_THAT(validate(file_), IsEmpty());
}

TEST_F(Regression, TellsOfEveryDeparture) {
  StoredForces one = sample_forces();
  one.date = "yesterday";
  one.channels[0].unit = "kg";
  one.force[3] = std::numeric_limits<double>::quiet_NaN();
  write_regression(file_, {one});
  {
    auto file = h5::WritableFile::open(file_);
    const auto group = h5::open(file.id(), "/cases/a blade, slowly");
    h5::delete_attribute(group.id(), "reason");
    h5::delete_attribute(group.id(), "tick_cost_build");
    h5::write_attribute(group.id(), "note", std::string("x"));
  }
  std::string all;
  for (const auto& [where, found, expected] : validate(file_)) all += where + ": " + found + '\n';
  EXPECT_EQ(all,
            "/cases/a blade, slowly attribute 'reason': nothing\n"
            "/cases/a blade, slowly attribute 'tick_cost_build': nothing\n"
            "/cases/a blade, slowly attribute 'note': an attribute\n"
            "/cases/a blade, slowly attribute 'date': 'yesterday'\n"
            "/cases/a blade, slowly/force attribute 'units': 'kg'\n"
            "/cases/a blade, slowly/force: no finite number in row 1\n");
}

}  // namespace
}  // namespace kerf::schema
