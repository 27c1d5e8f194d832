#include <cmath>

#include <gtest/gtest.h>

#include <kerf/schema/recording_file.h>
#include <kerf/schema/recording_writer.h>

#include "datasets-schema/changed_file.h"
#include "datasets-schema/recording/live_rows.h"
#include "datasets-schema/recording/read_by_column.h"
#include "datasets-schema/recording/same_recording.h"
#include "datasets-schema/recording/sample_recording.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

TEST(RecordingFile, HoldsWhatReadingItWholeGivesBitForBit) {
  const test::TemporaryFolder folder;
  for (const std::size_t rows : {0U, 1U, 5U, 70'000U}) {
    write_recording(folder / "r.h5", test::sample_recording(rows));
    const RecordingFile file(folder / "r.h5");
    EXPECT_EQ(file.rows(), rows);
    EXPECT_FALSE(file.is_live());
    test::expect_same(test::read_in_pieces(file, rows > 5 ? 999 : 2), read_recording(folder / "r.h5"));
  }
}

TEST(RecordingFile, ReadsNoRowWhenItOpens) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  const RecordingFile file(folder / "r.h5");
  EXPECT_EQ(file.about().rows(), 0U);
  EXPECT_TRUE(file.about().position.empty());
  ASSERT_EQ(file.about().channels.size(), 2U);
  EXPECT_EQ(file.about().channels[0].unit, "K");
  EXPECT_TRUE(file.about().channels[0].values.empty());
}

TEST(RecordingFile, ReadsAnyStretchOfAColumn) {
  const test::TemporaryFolder folder;
  const Recording whole = test::sample_recording(3000);
  write_recording(folder / "r.h5", whole);
  const RecordingFile file(folder / "r.h5");
  std::vector<double> two_axes(6);
  file.read(Column::force_measured, 1234, 3, two_axes);
  for (std::size_t i = 0; i < two_axes.size(); ++i) EXPECT_EQ(two_axes[i], whole.force_measured[2468 + i]);
  std::vector<std::uint64_t> ticks(10);
  file.read_ticks(2990, ticks);
  EXPECT_EQ(ticks.back(), whole.tick.back());
  file.read(Column::time, 3000, 0, {});
}

TEST(RecordingFile, KnowsWhenItBeganAndEndedAndItsPeriod) {
  const test::TemporaryFolder folder;
  Recording recording = test::sample_recording(20'000);
  for (std::size_t i = 10'000; i < 20'000; ++i) recording.time[i] += 500.0;  // a pause is no period
  write_recording(folder / "r.h5", recording);
  const RecordingFile file(folder / "r.h5");
  EXPECT_EQ(file.first_time_s(), recording.time.front());
  EXPECT_EQ(file.last_time_s(), recording.time.back());
  EXPECT_NEAR(file.period_s(), 1e-3, 1e-12);
  for (std::size_t i = 0; i < 20'000; ++i)
    recording.time[i] = 1e-3 * std::floor(0.25 * static_cast<double>(i));
  write_recording(folder / "repeated.h5", recording);
  EXPECT_NEAR(RecordingFile(folder / "repeated.h5").period_s(), 1e-3, 1e-12)
      << "nor is a time that is told again";
  write_recording(folder / "empty.h5", test::sample_recording(0));
  const RecordingFile empty(folder / "empty.h5");
  EXPECT_TRUE(std::isnan(empty.first_time_s()));
  EXPECT_EQ(empty.period_s(), 0.0);
}

TEST(RecordingFile, SaysWhichColumnsThereAre) {
  const test::TemporaryFolder folder;
  Recording recording = test::sample_recording();
  recording.force_commanded.clear();
  recording.compute_time.clear();
  recording.flags.clear();
  write_recording(folder / "r.h5", recording);
  const RecordingFile file(folder / "r.h5");
  EXPECT_EQ(file.width(Column::position), 2U);
  EXPECT_EQ(file.width(Column::force_commanded), 0U);
  EXPECT_EQ(file.width(Column::wake_latency), 1U);
  EXPECT_EQ(file.width(Column::compute_time), 0U);
  EXPECT_FALSE(file.has_flags());
  std::vector<double> values(5);
  EXPECT_THROW(file.read(Column::compute_time, 0, 5, values), std::invalid_argument);
  EXPECT_THROW(file.read_channel(2, 0, values), std::invalid_argument);
}

TEST(RecordingFile, RefusesRowsThatAreNotThere) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  const RecordingFile file(folder / "r.h5");
  std::vector<double> values(6);
  EXPECT_THROW(file.read(Column::time, 0, 6, values), std::out_of_range);
  EXPECT_THROW(file.read(Column::time, UINT64_MAX, 6, values), std::out_of_range);
  EXPECT_THROW(file.read(Column::time, 0, 5, values), std::invalid_argument) << "5 rows, room for 6";
}

TEST(RecordingFile, OfAWriterAtWorkHoldsTheRowsThatReachedIt) {
  const test::TemporaryFolder folder;
  auto writer = test::live_writer(folder / "r.h5");
  for (const std::size_t rows : {1U, 700U, 2500U}) {
    writer.append(test::live_rows(writer.rows(), rows));
    writer.flush();
    const RecordingFile file(folder / "r.h5.partial");
    EXPECT_TRUE(file.is_live());
    EXPECT_EQ(file.rows(), rows);
    test::expect_same(test::read_in_pieces(file, 512), read_recording(folder / "r.h5.partial"));
  }
  const RecordingFile early(folder / "r.h5.partial");
  writer.append(test::live_rows(2500, 4000));
  writer.close("complete");
  EXPECT_EQ(early.rows(), 2500U) << "as it was when it was opened";
  EXPECT_EQ(test::read_by(early, Column::position, 1000).size(), 5000U);
  EXPECT_EQ(RecordingFile(folder / "r.h5").rows(), 4000U);
}

TEST(RecordingFile, EndsBeforeARowThatACrashKeptFromTheDisk) {
  const test::ChangedFile changed([](hid_t file) {
    test::set_text(file, "/", "status", "recording");
    const double missing = std::numeric_limits<double>::quiet_NaN();
    test::set_values<double>(file, "/samples/time", {0.0, 0.001, 0.002, missing, missing});
  });
  const RecordingFile file(changed.path());
  EXPECT_EQ(file.rows(), 3U);
  EXPECT_EQ(file.last_time_s(), 0.002);
}

TEST(RecordingFile, ReadsChunksThatAreDeflated) {
  const test::ChangedFile changed([](hid_t file) {
    test::remove_link(file, "/samples/channels/a");
    const auto dataset = h5::create_dataset(file, "/samples/channels/a", h5::native<double>(),
                                            {.extent = {5}, .chunk_rows = 2, .compressed = true});
    const std::vector<double> values{1.0, 2.0, 3.0, 4.0, 5.0};
    h5::write(dataset.id(), h5::native<double>(), values.data());
  });
  const RecordingFile file(changed.path());
  ASSERT_EQ(file.about().channels.back().name, "a");
  std::vector<double> values(3);
  file.read_channel(1, 1, values);
  EXPECT_EQ(values, (std::vector<double>{2.0, 3.0, 4.0}));
}

TEST(RecordingFile, LooksThroughTheTextsUnlessTheyAreKnown) {
  const test::TemporaryFolder folder;
  write_recording(folder / "r.h5", test::sample_recording());
  const RecordingFile file(folder / "r.h5", RecordingFile::Texts::known_to_be_sound);
  EXPECT_EQ(file.about().header.software, "kerf 0.1.0");
  std::string bytes = test::read_text(folder / "r.h5");
  bytes.append("GCOL\1\0\0\0", 8).append(16, '\xff');
  test::write_text(folder / "r.h5", bytes);
  EXPECT_THROW(RecordingFile{folder / "r.h5"}, FormatError);
}

}  // namespace
}  // namespace kerf::schema
