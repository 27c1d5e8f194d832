#include "merge/gathered_cells.h"

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

class GatheredSweep : public test::SweepFolder {
 protected:
  GatheredSweep() : plan_(plan_of(test::walls())) {}

  void write(const ShardName& name, const std::function<void(ShardWriter&)>& fill) const {
    std::filesystem::create_directories(file("s"));
    ShardWriter writer(plan_, name, name.place_in(file("s")), [](const CellRecord&) {});
    writer.require_layout(1, R"(["walls",["a","1"]])");
    fill(writer);
  }
  static void computed(ShardWriter& writer, std::uint64_t cell, double value) {
    std::string frame;
    add_computed(frame, cell, 0.1, 1, {&value, 1});
    writer.append(frame);
  }
  static void failed(ShardWriter& writer, std::uint64_t cell, Failure failure) {
    std::string frame;
    add_failed(frame, {.cell = cell, .failure = failure, .why = "why"});
    writer.append(frame);
  }
  static double value_of(const GatheredCells& cells, std::uint64_t cell) {
    const CellRecord record = cells.record(cell);
    return std::get<ComputedCell>(record).values().at(0);
  }

  PlanFile plan_;
};

TEST_F(GatheredSweep, TakesTheAnswerOfACellThatFailedElsewhere) {
  write({.shard = 0, .shards = 2}, [](ShardWriter& writer) {
    failed(writer, 3, Failure::crashed);
    computed(writer, 4, 1.0);
  });
  write({.shard = 0, .shards = 3}, [](ShardWriter& writer) {
    computed(writer, 3, 2.0);
    failed(writer, 4, Failure::too_long);
  });
  const GatheredCells cells(plan_, file("s"));
  EXPECT_EQ(cells.computed(), 2U);
  EXPECT_EQ(cells.failed(), 0U);
  EXPECT_EQ(cells.missing(), 18U);
  EXPECT_EQ(value_of(cells, 3), 2.0);
  EXPECT_EQ(value_of(cells, 4), 1.0);
}

TEST_F(GatheredSweep, CountsCellsThatTwoComputedToOtherNumbers) {
  write({.shard = 0, .shards = 2}, [](ShardWriter& writer) {
    computed(writer, 1, 1.0);
    computed(writer, 2, 5.0);
  });
  write({.shard = 0, .shards = 1}, [](ShardWriter& writer) {
    computed(writer, 1, 1.0 + 1e-12);
    computed(writer, 2, 5.0);
  });
  const GatheredCells cells(plan_, file("s"));
  EXPECT_EQ(cells.different(), (std::set<std::uint64_t>{1}));
  EXPECT_NEAR(cells.largest_difference(), 1e-12, 1e-15);
}

TEST_F(GatheredSweep, IsRefusedWhereACompleteShardIsDamaged) {
  write({}, [](ShardWriter& writer) {
    for (std::uint64_t cell = 0; cell < 20; ++cell) computed(writer, cell, 1.0);
    writer.finish();
  });
  const auto place = file("s/0-of-1.shard");
  std::string bytes = test::read_text(place);
  bytes[bytes.size() / 2] ^= 1;
  test::write_text(place, bytes);
  EXPECT_THROW(GatheredCells(plan_, file("s")), std::invalid_argument);
}

TEST(ShardNumbers, AreListedAsArraysTakeThem) {
  EXPECT_EQ(as_ranges({}), "");
  EXPECT_EQ(as_ranges({3, 7, 12, 13, 14}), "3,7,12-14");
}

}  // namespace
}  // namespace kerf::bench
