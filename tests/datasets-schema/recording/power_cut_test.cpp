// What a recording is worth after the power went at any moment while it was written.
//
// What was asked of the disk is kept by the call. At a cut everything up to the last synchronisation is on
// the disk; of what came after it each page is there as any of the writes to it left it, or not at all, and
// the file may or may not have its new length.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/recording_writer.h>
#include <kerf/schema/repair.h>

#include "datasets-schema/recording/sample_recording.h"
#include "support/disks/disk_log.h"
#include "support/program.h"

namespace kerf::schema {
namespace {

using test::DiskCall;
using test::DiskLog;
using Kind = DiskCall::Kind;
using Bytes = std::vector<char>;

constexpr std::size_t page_size = 4096;  // what the system and the disk write whole
constexpr std::size_t rows_a_flush = 250;
constexpr std::size_t flushes_a_synchronisation = 4;

void apply(const DiskCall& call, Bytes& disk) {
  const auto at = static_cast<std::size_t>(call.at);
  if (call.kind == Kind::resize) disk.resize(at);
  if (call.kind != Kind::write) return;
  disk.resize(std::max(disk.size(), at + call.bytes.size()));
  std::ranges::copy(call.bytes, disk.begin() + call.at);
}

/// The pages as each of some calls has left those that it wrote to.
std::map<std::size_t, std::vector<Bytes>> versions_of(std::span<const DiskCall> calls, Bytes& disk) {
  std::map<std::size_t, std::vector<Bytes>> pages;
  for (const DiskCall& call : calls) {
    apply(call, disk);
    if (call.kind != Kind::write) continue;
    const auto first = static_cast<std::size_t>(call.at) / page_size;
    const std::size_t last = (static_cast<std::size_t>(call.at) + call.bytes.size() - 1) / page_size;
    for (std::size_t page = first; page <= last; ++page) {
      const std::size_t end = std::min(disk.size(), (page + 1) * page_size);
      pages[page].emplace_back(disk.begin() + static_cast<std::ptrdiff_t>(page * page_size),
                               disk.begin() + static_cast<std::ptrdiff_t>(end));
    }
  }
  return pages;
}

/// A recording of so many rows, written as the recorder writes, and what it asked of the disk until close().
class RecordedWrites {
 public:
  explicit RecordedWrites(std::size_t rows) : log_(folder_.path()) {
    Recording about = test::sample_recording(0);
    RecordingWriter writer(folder_ / "r.h5", about.header, about.axes,
                           {.measures_force = true, .channels = {{.name = "c", .unit = "1", .values = {}}}});
    for (std::size_t row = 0; row < rows; ++row) {
      const auto x = static_cast<double>(row);
      writer.append(std::vector<Row>{{.tick = row, .time_s = x, .position = {x, -x}, .channels = {x}}});
      if (row % 100 == 0) writer.append_event({.time_s = x, .kind = "contact", .text = "at the row"});
      if ((row + 1) % rows_a_flush == 0) writer.flush();
      if ((row + 1) % (rows_a_flush * flushes_a_synchronisation) == 0) {
        writer.synchronise();
        synchronised_.push_back({.calls = log_.calls().size(), .rows = row + 1});
      }
    }
    while_recording_ = log_.calls().size();
    writer.close("complete");
  }

  struct Cut {
    Bytes disk;
    std::size_t rows;  ///< that were synchronised before it
  };
  template <typename Random>
  [[nodiscard]] Cut cut(Random& random) const {
    const std::size_t at =
        std::uniform_int_distribution(synchronised_.front().calls, while_recording_)(random);
    const auto after = std::ranges::find_if(synchronised_, [at](const auto& one) { return one.calls > at; });
    const auto last = std::prev(after);
    const std::span calls(log_.calls());
    Bytes disk;
    for (const DiskCall& call : calls.first(last->calls)) apply(call, disk);
    Bytes whole = disk;
    const auto pages = versions_of(calls.subspan(last->calls, at - last->calls), whole);
    if (std::bernoulli_distribution()(random)) disk.resize(std::max(disk.size(), whole.size()));
    for (const auto& [page, versions] : pages) {
      const auto kept = std::uniform_int_distribution<std::size_t>(0, versions.size())(random);
      const std::size_t begin = page * page_size;
      if (kept == 0 || begin >= disk.size()) continue;
      const Bytes& version = versions[kept - 1];
      std::copy_n(version.begin(), std::min(version.size(), disk.size() - begin),
                  disk.begin() + static_cast<std::ptrdiff_t>(begin));
    }
    return {.disk = std::move(disk), .rows = last->rows};
  }
  [[nodiscard]] const std::vector<DiskCall>& calls() const { return log_.calls(); }

 private:
  struct Synchronised {
    std::size_t calls;
    std::size_t rows;
  };
  test::TemporaryFolder folder_;
  DiskLog log_;
  std::vector<Synchronised> synchronised_;
  std::size_t while_recording_ = 0;
};

void expect_rows(const Recording& recording, std::size_t rows) {
  ASSERT_GE(recording.rows(), rows);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto x = static_cast<double>(row);
    ASSERT_EQ(recording.time[row], x);
    ASSERT_EQ(recording.tick[row], row);
    ASSERT_EQ(recording.position[2 * row + 1], -x);
    ASSERT_EQ(recording.channels.front().values[row], x);
  }
  EXPECT_GE(recording.events.size(), rows / 100);
}

TEST(PowerCut, LosesNoRowThatWasSynchronised) {
  const RecordedWrites writes(20'000);
  const test::TemporaryFolder folder;
  std::mt19937_64 random(1);
  for (int i = 0; i < 300; ++i) {
    const auto cut = writes.cut(random);
    std::ofstream(folder / "r.h5.partial", std::ios::binary)
        .write(cut.disk.data(), static_cast<std::streamsize>(cut.disk.size()));
    ASSERT_NO_THROW(expect_rows(read_recording(folder / "r.h5.partial"), cut.rows)) << "cut " << i;
    ASSERT_NO_THROW((void)repair(folder / "r.h5", {})) << "cut " << i;
    expect_rows(read_recording(folder / "r.h5"), cut.rows);
    if (HasFailure()) FAIL() << "cut " << i;
    std::filesystem::remove(folder / "r.h5");
  }
}

TEST(PowerCut, AtTheEndFindsTheBytesBeforeTheNameAndTheNameItself) {
  const RecordedWrites writes(1000);
  std::vector<Kind> order;
  for (const DiskCall& call : writes.calls()) order.push_back(call.kind);
  ASSERT_GE(order.size(), 3U);
  EXPECT_EQ(std::vector(order.end() - 3, order.end()),
            (std::vector{Kind::synchronise, Kind::rename, Kind::synchronise_names}));
}

TEST(PowerCut, AtTheBeginningFindsTheNameOnceRowsAreSynchronised) {
  const RecordedWrites writes(5000);
  const auto first = std::ranges::find(writes.calls(), Kind::synchronise, &DiskCall::kind);
  EXPECT_NE(std::find_if(first, writes.calls().end(),
                         [](const DiskCall& call) { return call.kind == Kind::synchronise_names; }),
            writes.calls().end());
  EXPECT_EQ(std::next(first)->kind, Kind::synchronise_names);
  EXPECT_EQ(std::ranges::count(writes.calls(), Kind::synchronise_names, &DiskCall::kind), 2)
      << "once for this name and once for the last, however often rows are synchronised";
}

}  // namespace
}  // namespace kerf::schema
