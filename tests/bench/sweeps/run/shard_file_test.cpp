#include "run/shard_file.h"

#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"

namespace kerf::bench {
namespace {

class ShardFile : public test::SweepFolder {
 protected:
  ShardFile() : plan_(plan_of(test::walls())) {}

  std::set<std::uint64_t> write(const std::set<std::uint64_t>& cells, bool finish) const {
    std::set<std::uint64_t> there;
    ShardWriter writer(plan_, {}, place_, [&](const CellRecord& record) {
      if (const auto* const computed = std::get_if<ComputedCell>(&record)) there.insert(computed->cell);
    });
    writer.require_layout(1, R"(["walls",["a","1"]])");
    for (const std::uint64_t cell : cells) {
      std::string frame;
      const double value = static_cast<double>(cell);
      add_computed(frame, cell, 0.1, 1, {&value, 1});
      writer.append(frame);
    }
    if (finish) writer.finish();
    return there;
  }

  PlanFile plan_;
  std::filesystem::path place_ = file("0-of-1.shard");
  std::filesystem::path partial_ = partial_shard(place_);
};

TEST_F(ShardFile, GoesOnWhereverItWasCutOff) {
  (void)write({}, false);
  const auto empty = std::filesystem::file_size(partial_);
  (void)write({0, 1, 2}, false);
  const std::string whole = test::read_text(partial_);
  const auto record = (whole.size() - empty) / 3;
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    test::write_text(partial_, whole.substr(0, cut));
    const std::size_t kept = cut < empty ? 0 : (cut - empty) / record;
    std::set<std::uint64_t> missing;
    for (std::uint64_t cell = kept; cell < 3; ++cell) missing.insert(cell);
    EXPECT_EQ(write(missing, false).size(), kept) << cut;
    EXPECT_EQ(test::read_text(partial_), whole) << cut;
  }
}

TEST_F(ShardFile, HasItsFinalNameOnceItIsFinished) {
  (void)write({0}, false);
  EXPECT_FALSE(std::filesystem::exists(place_));
  (void)write({1}, true);
  EXPECT_TRUE(std::filesystem::exists(place_));
  EXPECT_FALSE(std::filesystem::exists(partial_));
}

TEST_F(ShardFile, OfAnotherPlanIsRefused) {
  (void)write({0}, false);
  plan_ = plan_of(test::walls("shards = 2\n") + "damping = 1\n");
  try {
    (void)write({1}, false);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("it is of another plan"), std::string::npos) << error.what();
  }
}

TEST_F(ShardFile, ThatIsNoneIsRefusedAndStays) {
  const std::string text(300, 'x');
  test::write_text(partial_, text);
  EXPECT_THROW((void)write({1}, false), std::invalid_argument);
  EXPECT_EQ(test::read_text(partial_), text);
}

TEST(ShardName, StandsInFoldersOfAThousand) {
  EXPECT_EQ((ShardName{.shard = 3, .shards = 100}.place_in("s")), "s/3-of-100.shard");
  EXPECT_EQ((ShardName{.shard = 1234, .shards = 5000}.place_in("s")), "s/1/1234-of-5000.shard");
}

}  // namespace
}  // namespace kerf::bench
