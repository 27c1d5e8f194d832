#include "run/cell_records.h"

#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr std::array<double, 3> numbers{1.5, -2.0, 1e-300};

std::string frames() {
  std::string all;
  const std::string layout = CellLayout{.table = "t", .columns = {{.name = "a", .unit = "N"}}}.as_text();
  add_layout(all, CellLayout::number_of(layout), layout);
  add_computed(all, 7, 0.25, 3, numbers);
  add_failed(all, {.cell = 8, .seconds = 1.0, .failure = Failure::crashed, .why = "its worker ended"});
  return all;
}

std::vector<CellRecord> records_in(std::string_view bytes) {
  std::vector<CellRecord> records;
  while (const auto frame = first_frame(bytes)) {
    records.push_back(frame->record);
    bytes.remove_prefix(frame->size);
  }
  return records;
}

TEST(CellRecords, ComeBackAsTheyWereWritten) {
  const std::string bytes = frames();
  const std::vector<CellRecord> records = records_in(bytes);
  ASSERT_EQ(records.size(), 3U);
  const CellLayout layout = CellLayout::from_text(std::get<LayoutRecord>(records[0]).text);
  EXPECT_EQ(layout.table, "t");
  EXPECT_EQ(layout.columns, (std::vector<CellColumn>{{.name = "a", .unit = "N"}}));
  const auto& computed = std::get<ComputedCell>(records[1]);
  EXPECT_EQ(computed.cell, 7U);
  EXPECT_EQ(computed.seconds, 0.25);
  EXPECT_EQ(computed.values(), std::vector<double>(numbers.begin(), numbers.end()));
  const auto& failed = std::get<FailedCell>(records[2]);
  EXPECT_EQ(failed.failure, Failure::crashed);
  EXPECT_EQ(failed.why, "its worker ended");
}

TEST(CellRecords, AreWholeOrNotThereWhereverTheyAreCut) {
  const std::string bytes = frames();
  std::vector<std::size_t> ends;
  std::string_view left = bytes;
  while (!left.empty()) {
    left.remove_prefix(first_frame(left)->size);
    ends.push_back(bytes.size() - left.size());
  }
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    std::size_t whole = 0;
    for (const std::size_t end : ends) whole += end <= cut ? 1 : 0;
    EXPECT_EQ(records_in(std::string_view(bytes).substr(0, cut)).size(), whole) << cut;
  }
}

TEST(CellRecords, OfWhichOneBitChangedAreNotTaken) {
  const std::string bytes = frames();
  const std::size_t last = records_in(bytes).size();
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_LT(records_in(changed).size(), last) << at;
  }
}

}  // namespace
}  // namespace kerf::bench
