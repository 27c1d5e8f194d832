#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/studio/views/long_recording.h"
#include "support/program.h"
#include "views/recording_view.h"

namespace kerf::bench {
namespace {

constexpr std::size_t prepared_rows = 100'000;
constexpr RecordingView::WaitedFor waited_for{.rows = 1000, .bytes = 1000};
const std::vector<std::size_t> prepared_traces{0, 1, 11};

/// A recording of more rows than anybody waits for.
class RecordingPreparation : public testing::Test {
 protected:
  RecordingPreparation() { schema::write_recording(file_, rows_); }

  static void wait_for(RecordingView& recording) {
    while (recording.prepared() < 1.0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  [[nodiscard]] ViewCache cache() const { return ViewCache(folder_ / "cache"); }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "r.h5";
  schema::Recording rows_ = test::long_recording(prepared_rows);
};

TEST_F(RecordingPreparation, ShowsSomeRowsOfEachColumnMeanwhileAndSaysSo) {
  RecordingView recording(file_, cache(), waited_for);
  const auto pause = recording.pause();
  const TraceView view = recording.view(prepared_traces, 0.0, 1e9, 100);
  EXPECT_LT(recording.prepared(), 1.0);
  EXPECT_LT(view.prepared, 1.0);
  EXPECT_EQ(view.rows_looked_at, 64.0);
  EXPECT_EQ(recording.rows(), nullptr);
  ASSERT_EQ(view.time_s.size(), 100U);
  for (std::size_t i = 0; i < 100; ++i) {
    // The channel counts the rows.
    const auto first = static_cast<std::size_t>(view.traces[2].smallest[i]);
    EXPECT_EQ(view.time_s[i], rows_.time[first]);
    EXPECT_EQ(view.traces[2].largest[i], view.traces[2].smallest[i] + 63.F);
    double most = -1e9;
    for (std::size_t row = first; row < first + 64; ++row) most = std::max(most, rows_.position[2 * row]);
    EXPECT_NEAR(static_cast<double>(view.traces[0].largest[i]), most, 1e-6 * std::abs(most));
  }
}

TEST_F(RecordingPreparation, ShowsEveryRowFromNearMeanwhile) {
  RecordingView recording(file_, cache(), waited_for);
  const auto pause = recording.pause();
  const TraceView view = recording.view(prepared_traces, rows_.time[70'000], rows_.time[70'004], 1200);
  EXPECT_THAT(view.traces[2].smallest,
              testing::ElementsAre(69'999.F, 70'000.F, 70'001.F, 70'002.F, 70'003.F, 70'004.F));
}

TEST_F(RecordingPreparation, EndsInTheSameAsWaitingForIt) {
  RecordingView recording(file_, cache(), waited_for);
  wait_for(recording);
  RecordingView waited(file_, ViewCache({}));
  EXPECT_EQ(bytes_of(recording.view(prepared_traces, 0.0, 1e9, 100)),
            bytes_of(waited.view(prepared_traces, 0.0, 1e9, 100)));
  ASSERT_NE(recording.rows(), nullptr);
  EXPECT_EQ(recording.rows()->gaps_in_all(), waited.rows()->gaps_in_all());
  EXPECT_GT(recording.bytes(), 0U);
}

TEST_F(RecordingPreparation, IsNotDoneAgainForTheSameFile) {
  {
    RecordingView recording(file_, cache(), waited_for);
    wait_for(recording);
  }
  RecordingView again(file_, cache(), waited_for);
  EXPECT_EQ(again.prepared(), 1.0);
  EXPECT_EQ(again.view(prepared_traces, 0.0, 1e9, 100).prepared, 1.0);
}

/// Says of the free rest of a heap of texts that it is shorter: HDF5 reads the texts all the same.
void damage_texts(const std::filesystem::path& file) {
  std::string bytes = test::read_text(file);
  std::size_t at = bytes.find(std::string("GCOL\1\0\0\0", 8)) + 16;
  const auto number = [&](std::size_t from, std::size_t size) {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes.data() + from, size);
    return value;
  };
  while (number(at, 2) != 0) at += 16 + (number(at + 8, 8) + 7) / 8 * 8;
  const std::uint64_t shorter = number(at + 8, 8) - 8;
  std::memcpy(bytes.data() + at + 8, &shorter, sizeof shorter);
  test::write_text(file, bytes);
}

TEST_F(RecordingPreparation, FindsThatTextsAreDamagedAndTrustsThemNoMore) {
  damage_texts(file_);
  EXPECT_THROW(RecordingView(file_, cache()), schema::FormatError) << "whoever waits is told at once";
  for (int turn = 0; turn < 2; ++turn) {
    RecordingView recording(file_, cache(), waited_for);
    std::string said;
    while (said.empty()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      try {
        (void)recording.view(prepared_traces, 0.0, 1e9, 100);
      } catch (const schema::FormatError& error) {
        said = error.what();
      }
    }
    EXPECT_THAT(said, testing::HasSubstr("its texts are overwritten or cut off"));
    EXPECT_LT(recording.prepared(), 1.0);
  }
}

TEST_F(RecordingPreparation, EndsWithWhoeverLookedAtIt) {
  for (int turn = 0; turn < 20; ++turn) {
    RecordingView recording(file_, ViewCache({}), waited_for);
    if (turn % 2 == 1) (void)recording.view(prepared_traces, 0.0, 1e9, 100);
  }
}

TEST(RowPreparation, SaysWhatEndedIt) {
  RowPreparation preparation;
  EXPECT_EQ(preparation.done(), 1.0) << "there was nothing to do";
  preparation.start(100, [](const RowPreparation::GoOn& go_on) {
    go_on(50);
    throw std::runtime_error("the file is damaged");
  });
  std::optional<std::string> said;
  while (!said) {
    try {
      preparation.rethrow_failure();
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
  }
  EXPECT_EQ(*said, "the file is damaged");
  EXPECT_EQ(preparation.done(), 0.5);
}

}  // namespace
}  // namespace kerf::bench
