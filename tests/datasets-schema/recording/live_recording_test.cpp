#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/schema/live_recording.h>

#include "datasets-schema/changed_file.h"
#include "datasets-schema/recording/live_rows.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(ReadTail, FollowsARecordingWhileItGrows) {
  const test::TemporaryFolder folder;
  auto writer = test::live_writer(folder / "r.h5");
  EXPECT_EQ(read_tail(folder / "r.h5.partial").rows, 0U);
  for (const std::size_t rows : {1U, 700U, 2500U}) {
    writer.append(test::live_rows(writer.rows(), rows));
    writer.flush();
    const Tail tail = read_tail(folder / "r.h5.partial");
    EXPECT_EQ(tail.status, "recording");
    EXPECT_EQ(tail.rows, rows);
    EXPECT_EQ(tail.last.tick, rows - 1);
    EXPECT_DOUBLE_EQ(tail.last.time_s, 1e-3 * static_cast<double>(rows - 1));
    EXPECT_EQ(tail.last.position[1], -static_cast<double>(rows - 1));
    EXPECT_EQ(tail.last.force_measured[0], 0.5 * static_cast<double>(rows - 1));
  }
  writer.append_event({.time_s = 2.5, .kind = "watchdog", .text = "it stalled"});
  writer.flush();
  const Tail tail = read_tail(folder / "r.h5.partial");
  EXPECT_EQ(tail.events, 1U);
  ASSERT_TRUE(tail.last_event);
  EXPECT_EQ(tail.last_event->kind, "watchdog");
  EXPECT_EQ(tail.axes.size(), 2U);
  EXPECT_EQ(tail.axes[1].position_unit, "m");
  writer.close("complete");
  EXPECT_EQ(read_tail(folder / "r.h5").status, "complete");
  EXPECT_EQ(read_tail(folder / "r.h5").rows, 2500U);
}

TEST(ReadTail, RefusesWhatIsNoRecording) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "r.h5", "no recording");
  EXPECT_THROW((void)read_tail(folder / "r.h5"), FormatError);
  EXPECT_THROW((void)read_tail(folder / "none.h5"), std::invalid_argument);
}

TEST(ReadTail, RefusesColumnsWiderThanTheAxes) {
  const test::ChangedFile file([](hid_t opened) {
    test::replace_dataset<double>(opened, "/samples/velocity", {5, 1000});
  });
  EXPECT_THAT([&] { (void)read_tail(file.path()); },
              ThrowsMessage<FormatError>(HasSubstr("/samples/velocity: found 1000 columns, expected 2")));
}

TEST(ReadTail, RefusesEventsOfAnotherShape) {
  const test::ChangedFile file([](hid_t opened) { test::replace_dataset<double>(opened, "/events", {3}); });
  EXPECT_THAT([&] { (void)read_tail(file.path()); },
              ThrowsMessage<FormatError>(HasSubstr("/events: found float64")));
}

TEST(ReadTail, ReadsARecordingWithoutAStatus) {
  const test::ChangedFile file([](hid_t opened) { test::remove_attribute(opened, "/", "status"); });
  EXPECT_EQ(read_tail(file.path()).status, "");
  EXPECT_EQ(read_tail(file.path()).rows, 5U);
}

TEST(FindRecording, KnowsWhetherSomebodyWritesIt) {
  const test::TemporaryFolder folder;
  {
    auto writer = test::live_writer(folder / "r.h5");
    writer.append(test::live_rows(0, 10));
    for (const auto* name : {"r.h5", "r.h5.partial"}) {
      const Place place = find_recording(folder / name);
      EXPECT_EQ(place.file, folder / "r.h5.partial");
      EXPECT_TRUE(place.partial);
      EXPECT_TRUE(place.being_written);
    }
  }
  EXPECT_FALSE(find_recording(folder / "r.h5").being_written) << "its writer left it";
  std::filesystem::remove(folder / "r.h5.partial");
  auto writer = test::live_writer(folder / "r.h5");
  writer.close("complete");
  const Place place = find_recording(folder / "r.h5.partial");
  EXPECT_EQ(place.file, folder / "r.h5");
  EXPECT_FALSE(place.partial);
  EXPECT_THROW((void)find_recording(folder / "none.h5"), std::invalid_argument);
}

TEST(RecordingWriter, IsRefusedTheFileOfAnotherProcess) {
  const test::TemporaryFolder folder;
  const auto writer = test::live_writer(folder / "r.h5");
  try {
    (void)test::live_writer(folder / "r.h5");
    FAIL() << "two writers of one file";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("is being recorded by another process"));
  }
}

}  // namespace
}  // namespace kerf::schema
