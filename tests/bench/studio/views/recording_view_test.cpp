#include "views/recording_view.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording_writer.h>

#include "bench/studio/views/long_recording.h"
#include "support/program.h"
#include "views/recording_views.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;

std::vector<std::string> names_of(const RecordingView& recording) {
  std::vector<std::string> names;
  for (const Trace& trace : recording.traces()) names.push_back(trace.name);
  return names;
}

/// A trace's values, from the recording in memory.
std::vector<double> values_of(const schema::Recording& recording, const std::string& name) {
  const auto axis = [&](const std::vector<double>& all) {
    std::vector<double> values;
    for (std::size_t i = name.ends_with("theta") ? 0 : 1; i < all.size(); i += 2) values.push_back(all[i]);
    return values;
  };
  if (name.starts_with("position")) return axis(recording.position);
  if (name.starts_with("velocity")) return axis(recording.velocity);
  if (name.starts_with("force_commanded")) return axis(recording.force_commanded);
  if (name.starts_with("grip")) return recording.channels[0].values;
  std::vector<double> values;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    values.push_back(name == "wake_latency"   ? static_cast<double>(recording.wake_latency[i])
                     : name == "compute_time" ? static_cast<double>(recording.compute_time[i])
                                              : static_cast<double>(recording.read_time[i]) +
                                                    static_cast<double>(recording.compute_time[i]) +
                                                    static_cast<double>(recording.write_time[i]));
  }
  return values;
}

/// Every column of a view has the extremes of the rows from its time to that of the next.
void expect_extremes(const TraceView& view, std::size_t trace, const std::vector<double>& time_s,
                     const std::vector<double>& values) {
  const auto& [smallest, largest] = view.traces[trace];
  ASSERT_EQ(smallest.size(), view.time_s.size());
  for (std::size_t i = 0; i + 1 < view.time_s.size(); ++i) {
    const auto first = std::lower_bound(time_s.begin(), time_s.end(), view.time_s[i]);
    const auto end = std::lower_bound(time_s.begin(), time_s.end(), view.time_s[i + 1]);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (auto row = first; row < end; ++row) {
      const double value = values[static_cast<std::size_t>(row - time_s.begin())];
      if (!std::isfinite(value)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    if (least > most) {
      EXPECT_TRUE(std::isnan(smallest[i]));
      continue;
    }
    EXPECT_LE(static_cast<double>(smallest[i]), least);
    EXPECT_NEAR(static_cast<double>(smallest[i]), least, 1e-6 * std::abs(least));
    EXPECT_GE(static_cast<double>(largest[i]), most);
    EXPECT_NEAR(static_cast<double>(largest[i]), most, 1e-6 * std::abs(most));
  }
}

TEST(RecordingView, ListsTheTracesAxisByAxis) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::long_recording(10));
  const RecordingView recording(folder / "r.h5", ViewCache({}));
  EXPECT_THAT(names_of(recording),
              ElementsAre("position theta", "velocity theta", "force_commanded theta", "position x_s",
                          "velocity x_s", "force_commanded x_s", "wake_latency", "read_time", "compute_time",
                          "write_time", "cycle_time", "grip \"µ\""));
  EXPECT_EQ(recording.traces()[1].unit, "rad/s");
  EXPECT_EQ(recording.traces()[2].unit, "N·m");
  EXPECT_EQ(recording.traces()[2].group, "force");
  EXPECT_EQ(recording.traces()[10].group, "timing");
  EXPECT_EQ(recording.traces()[11].unit, "K");
}

TEST(RecordingView, OfAnImportHasNoTimings) {
  const test::TemporaryFolder folder;
  schema::Recording recording = test::long_recording(10);
  for (auto* column : {&recording.wake_latency, &recording.read_time, &recording.write_time}) column->clear();
  recording.force_commanded.clear();
  schema::write_recording(folder / "r.h5", recording);
  EXPECT_THAT(names_of(RecordingView(folder / "r.h5", ViewCache({}))),
              ElementsAre("position theta", "velocity theta", "position x_s", "velocity x_s", "compute_time",
                          "grip \"µ\""));
}

TEST(RecordingView, GivesTheExtremesOfTheRowsAtAnyZoom) {
  const test::TemporaryFolder folder;
  const schema::Recording rows = test::long_recording(30'000);
  schema::write_recording(folder / "r.h5", rows);
  RecordingView recording(folder / "r.h5", ViewCache(folder / "cache"));
  const std::vector<std::size_t> shown{0, 3, 1, 5, 8, 10, 11};
  std::mt19937 random(4);
  std::uniform_real_distribution<double> place(0.0, 31.0);
  for (int turn = 0; turn < 40; ++turn) {
    const double from_s = place(random);
    const double to_s = from_s + std::pow(10.0, -3.0 * place(random) / 31.0) * (31.0 - from_s);
    const std::size_t columns = 1 + random() % 300;
    const TraceView view = recording.view(shown, from_s, to_s, columns);
    ASSERT_LE(view.time_s.size(), columns);
    ASSERT_EQ(view.traces.size(), shown.size());
    if (view.time_s.empty()) continue;
    EXPECT_LE(view.time_s.front(), std::max(from_s, rows.time.front()));
    for (std::size_t i = 0; i < shown.size(); ++i) {
      expect_extremes(view, i, rows.time, values_of(rows, recording.traces()[shown[i]].name));
    }
  }
}

TEST(RecordingView, ShowsEveryRowFromNear) {
  const test::TemporaryFolder folder;
  const schema::Recording rows = test::long_recording(5000);
  schema::write_recording(folder / "r.h5", rows);
  RecordingView recording(folder / "r.h5", ViewCache({}));
  const std::vector<std::size_t> shown{11};
  const TraceView view = recording.view(shown, rows.time[1000], rows.time[1005], 1200);
  EXPECT_EQ(view.rows_per_column, 1.0);
  EXPECT_THAT(view.time_s, ElementsAre(rows.time[999], rows.time[1000], rows.time[1001], rows.time[1002],
                                       rows.time[1003], rows.time[1004], rows.time[1005]))
      << "and the one before, from which a line comes in";
  EXPECT_THAT(view.traces[0].smallest, ElementsAre(999.F, 1000.F, 1001.F, 1002.F, 1003.F, 1004.F, 1005.F));
  EXPECT_EQ(view.traces[0].smallest, view.traces[0].largest);
}

TEST(RecordingView, HasNoColumnsOutsideTheRecording) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::long_recording(100));
  RecordingView recording(folder / "r.h5", ViewCache({}));
  const std::vector<std::size_t> shown{0, 1};
  for (const auto& [from_s, to_s] : {std::pair{-2.0, -1.0}, {5.0, 6.0}, {0.6, 0.4}, {std::nan(""), 1.0}}) {
    const TraceView view = recording.view(shown, from_s, to_s, 100);
    EXPECT_TRUE(view.time_s.empty());
    EXPECT_EQ(view.traces.size(), 2U);
  }
  EXPECT_THROW((void)recording.view(std::vector<std::size_t>{12}, 0.0, 1.0, 10), std::out_of_range);
  schema::write_recording(folder / "none.h5", test::long_recording(0));
  RecordingView empty(folder / "none.h5", ViewCache({}));
  EXPECT_TRUE(empty.view(shown, 0.0, 1.0, 10).time_s.empty());
}

TEST(RecordingView, FindsTimesThatLieIrregularly) {
  const test::TemporaryFolder folder;
  schema::Recording rows = test::long_recording(20'000, 2, true);
  schema::write_recording(folder / "r.h5", rows);
  RecordingView recording(folder / "r.h5", ViewCache({}));
  const std::vector<std::size_t> shown{11};
  for (const std::size_t row : {500U, 7777U, 19'990U}) {
    const TraceView view = recording.view(shown, rows.time[row], rows.time[row], 100);
    ASSERT_FALSE(view.time_s.empty());
    EXPECT_EQ(view.time_s.back(), rows.time[row]);
  }
  // The whole, in columns of many rows: each at the time of its first row.
  const TraceView whole = recording.view(shown, 0.0, 1e9, 50);
  ASSERT_EQ(whole.time_s.size(), 50U);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(whole.time_s[i], rows.time[static_cast<std::size_t>(whole.traces[0].smallest[i])]);
  }
}

TEST(RecordingView, FindsTimesThoughTheyGoBackOrAreMissing) {
  const test::TemporaryFolder folder;
  schema::Recording rows = test::long_recording(2000);
  for (std::size_t i = 1000; i < 1100; ++i) rows.time[i] = 0.1;
  for (std::size_t i = 1100; i < 1300; ++i) rows.time[i] = std::nan("");
  schema::write_recording(folder / "r.h5", rows);
  RecordingView recording(folder / "r.h5", ViewCache({}));
  const TraceView view = recording.view(std::vector<std::size_t>{11}, rows.time[1500], rows.time[1600], 4000);
  EXPECT_EQ(view.traces[0].smallest.front(), 1499.F);
  EXPECT_EQ(view.traces[0].smallest.back(), 1600.F);
}

TEST(RecordingView, TellsOfGapsAsSpansOfTime) {
  const test::TemporaryFolder folder;
  schema::Recording rows = test::long_recording(10'000);
  for (std::size_t i = 5000; i < 10'000; ++i) rows.tick[i] += 3;
  rows.flags[100] = schema::flag_rows_lost;
  rows.flags[101] = schema::flag_missed_deadline;
  rows.flags[200] = schema::flag_force_limited;
  rows.flags[0] = schema::flag_missed_deadline;
  schema::write_recording(folder / "r.h5", rows);
  const RecordingView recording(folder / "r.h5", ViewCache({}));
  EXPECT_THAT(recording.rows()->gaps(), ElementsAre(std::pair(rows.time[99], rows.time[101]),
                                                    std::pair(rows.time[4999], rows.time[5000])));
  EXPECT_EQ(recording.rows()->gaps_in_all(), 3U) << "two that touch are drawn as one";
}

TEST(RecordingView, TellsOfSoManyGapsAndCountsTheRest) {
  const test::TemporaryFolder folder;
  schema::Recording rows = test::long_recording(10'000);
  for (std::size_t i = 0; i < rows.rows(); i += 2) rows.flags[i] = schema::flag_rows_lost;
  schema::write_recording(folder / "r.h5", rows);
  const RecordingView recording(folder / "r.h5", ViewCache(folder / "cache"));
  EXPECT_EQ(recording.rows()->gaps().size(), RowIndex::max_gaps);
  EXPECT_EQ(recording.rows()->gaps_in_all(), 4999U);
  EXPECT_EQ(recording.rows()->gaps().back().second, rows.time[4000]);
  const RecordingView again(folder / "r.h5", ViewCache(folder / "cache"));
  EXPECT_EQ(again.rows()->gaps_in_all(), 4999U);
}

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  const std::filesystem::directory_iterator entries(folder);
  for (const auto& entry : entries) files.push_back(entry.path());
  return files;
}

TEST(RecordingView, IsTheSameFromTheCache) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::long_recording(20'000));
  const std::vector<std::size_t> shown{0, 1, 2, 10, 11};
  std::string first;
  for (int turn = 0; turn < 2; ++turn) {
    RecordingView recording(folder / "r.h5", ViewCache(folder / "cache"));
    const std::string bytes = bytes_of(recording.view(shown, 0.0, 100.0, 50));
    if (turn > 0) {
      EXPECT_EQ(bytes, first);
    }
    first = bytes;
  }
  EXPECT_EQ(files_in(folder / "cache").size(), 6U) << "rows, three datasets, cycle_time and the channel";
}

TEST(RecordingView, ComesFromTheCacheAlone) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::long_recording(20'000));
  const std::vector<std::size_t> shown{0};
  { (void)RecordingView(folder / "r.h5", ViewCache(folder / "cache")).view(shown, 0.0, 100.0, 50); }
  // Other extremes in the cache are seen: nothing was read again.
  for (const auto& file : files_in(folder / "cache")) {
    std::string bytes = test::read_text(file);
    const std::size_t numbers = 2 * (MinMaxPyramid::size_of(20'000) * sizeof(float));
    if (bytes.size() < numbers || bytes.size() > numbers + 200) continue;
    const float spike = 12345.0F;
    for (std::size_t at = bytes.size() - numbers; at < bytes.size(); at += sizeof spike) {
      std::memcpy(bytes.data() + at, &spike, sizeof spike);
    }
    test::write_text(file, bytes);
  }
  RecordingView recording(folder / "r.h5", ViewCache(folder / "cache"));
  EXPECT_EQ(recording.view(shown, 0.0, 100.0, 50).traces[0].largest[3], 12345.0F);
}

TEST(RecordingView, IsMadeAnewWhereTheCacheIsWrong) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::long_recording(20'000));
  const std::vector<std::size_t> shown{0, 1, 11};
  const auto seen = [&] {
    return bytes_of(RecordingView(folder / "r.h5", ViewCache(folder / "cache")).view(shown, 0.0, 100.0, 50));
  };
  const std::string expected = seen();
  std::mt19937 random(9);
  for (int turn = 0; turn < 60; ++turn) {
    for (const auto& file : files_in(folder / "cache")) {
      std::string bytes = test::read_text(file);
      if (turn % 3 == 0) bytes.resize(random() % bytes.size());
      if (turn % 3 == 1) bytes[random() % 136] ^= static_cast<char>(1 + random() % 255);
      if (turn % 3 == 2) bytes.append("x");
      test::write_text(file, bytes);
    }
    ASSERT_EQ(seen(), expected) << turn;
  }
}

TEST(RecordingView, NeedsNoCache) {
  const test::TemporaryFolder folder;
  schema::write_recording(folder / "r.h5", test::long_recording(20'000));
  test::write_text(folder / "file", "no folder");
  const std::vector<std::size_t> shown{0};
  RecordingView recording(folder / "r.h5", ViewCache(folder / "file"));
  EXPECT_EQ(recording.view(shown, 0.0, 100.0, 50).time_s.size(), 50U);
}

TEST(ViewCache, DropsWhatWasNotUsedForLongest) {
  const test::TemporaryFolder folder;
  const ViewCache cache(folder.path() / "cache", 40'000);
  const std::vector<std::byte> bytes(10'000);
  const ViewCache::Part part{.uuid = "u", .rows = 1, .bytes = bytes, .owner = {}};
  const auto facts = [](std::uint64_t number) {
    return FileFacts{.inode = number, .size = 1, .changed_ns = 2};
  };
  for (std::uint64_t i = 0; i < 3; ++i) {
    cache.keep(facts(i), "rows", part);
    for (const auto& file : files_in(folder / "cache")) {
      std::filesystem::last_write_time(file, std::filesystem::last_write_time(file) - std::chrono::hours(1));
    }
  }
  EXPECT_TRUE(cache.find(facts(0), "rows")) << "the oldest, but used just now";
  cache.keep(facts(3), "rows", part);
  EXPECT_TRUE(cache.find(facts(0), "rows"));
  EXPECT_FALSE(cache.find(facts(1), "rows"));
  EXPECT_TRUE(cache.find(facts(2), "rows"));
  EXPECT_TRUE(cache.find(facts(3), "rows"));
  EXPECT_FALSE(cache.find(facts(3), "position"));
}

schema::RecordingWriter live_writer(const std::filesystem::path& file) {
  return {file, schema::new_header("kerf test"), {{.name = "z"}}, {}};
}

std::vector<schema::Row> rows_from(std::size_t begin, std::size_t end) {
  std::vector<schema::Row> rows;
  for (std::size_t i = begin; i < end; ++i) {
    rows.push_back(
        {.tick = i, .time_s = 1e-3 * static_cast<double>(i), .position = {static_cast<double>(i)}});
  }
  return rows;
}

TEST(RecordingViews, FollowARecordingThatIsWrittenOnlyWhenAskedAnew) {
  const test::TemporaryFolder folder;
  RecordingViews views(ViewCache(folder / "cache"));
  auto writer = live_writer(folder / "r.h5");
  writer.append(rows_from(0, 5000));
  writer.flush();
  const auto first = views.current(folder / "r.h5.partial");
  EXPECT_EQ(first->file().rows(), 5000U);
  writer.append(rows_from(5000, 9000));
  writer.flush();
  EXPECT_EQ(views.opened(folder / "r.h5.partial"), first);
  const std::vector<std::size_t> shown{0};
  EXPECT_EQ(first->view(shown, 0.0, 10.0, 10).traces[0].largest.back(), 4999.0F);
  const auto second = views.current(folder / "r.h5.partial");
  EXPECT_EQ(second->file().rows(), 9000U);
  EXPECT_FALSE(std::filesystem::exists(folder / "cache")) << "what is still written is not kept";
  writer.close("complete");
  EXPECT_EQ(second->view(shown, 0.0, 10.0, 10).traces[0].largest.back(), 8999.0F);
  EXPECT_EQ(views.current(folder / "r.h5")->file().about().header.status, "complete");
}

TEST(RecordingViews, OpenWhatHasChangedAgain) {
  const test::TemporaryFolder folder;
  RecordingViews views(ViewCache(folder / "cache"));
  schema::write_recording(folder / "r.h5", test::long_recording(100));
  const auto first = views.opened(folder / "r.h5");
  EXPECT_EQ(views.opened(folder / "r.h5"), first);
  schema::write_recording(folder / "r.h5", test::long_recording(200));
  EXPECT_EQ(views.opened(folder / "r.h5")->file().rows(), 200U);
  EXPECT_EQ(first->file().rows(), 100U) << "for whoever still holds it";
}

TEST(RecordingViews, CloseTheOneThatWasNotAskedForForLongest) {
  const test::TemporaryFolder folder;
  RecordingViews views(ViewCache({}), 1'000'000);
  std::vector<std::weak_ptr<RecordingView>> seen;
  for (std::size_t i = 0; i < 10; ++i) {
    const auto file = folder / (std::to_string(i) + ".h5");
    schema::write_recording(file, test::long_recording(100));
    seen.push_back(views.opened(file));
    (void)views.opened(folder / "0.h5");
  }
  EXPECT_FALSE(seen[0].expired());
  EXPECT_TRUE(seen[1].expired());
  EXPECT_TRUE(seen[2].expired());
  EXPECT_FALSE(seen[3].expired());
}

TEST(RecordingViews, CloseOthersWhenTheirPyramidsTakeTooMuch) {
  const test::TemporaryFolder folder;
  RecordingViews views(ViewCache({}), 6000);
  const std::vector<std::size_t> shown{0};
  for (const char* name : {"a.h5", "b.h5"}) {
    schema::write_recording(folder / name, test::long_recording(20'000));
    (void)views.opened(folder / name)->view(shown, 0.0, 100.0, 10);
  }
  const std::weak_ptr<RecordingView> older = views.opened(folder / "b.h5");
  EXPECT_FALSE(older.expired());
  (void)views.opened(folder / "a.h5")->view(shown, 0.0, 100.0, 10);
  (void)views.opened(folder / "a.h5");
  EXPECT_TRUE(older.expired());
  EXPECT_THROW((void)views.opened(folder / "none.h5"), std::system_error);
}

}  // namespace
}  // namespace kerf::bench
