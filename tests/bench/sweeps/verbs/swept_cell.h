#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/sweeps/swept.h"
#include "verbs/sweep_verb.h"

namespace kerf::test {

/// Cells computed without shards.
class SweptCell : public SweepFolder {
 protected:
  [[nodiscard]] static bench::CellNumbers computed(const bench::PlanFile& plan, std::uint64_t cell = 0) {
    return plan.plan.verb->begin(plan.plan)->compute(plan.plan.cell(cell));
  }
  [[nodiscard]] static double value_of(const bench::CellNumbers& numbers, const std::string& name) {
    for (std::size_t i = 0; i < numbers.columns.size(); ++i)
      if (numbers.columns[i].name == name) return numbers.values[i];
    ADD_FAILURE() << "no column " << name;
    return 0.0;
  }
  /// Why a cell has no answer.
  [[nodiscard]] static std::string refusal(const bench::PlanFile& plan, std::uint64_t cell = 0) {
    try {
      (void)computed(plan, cell);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  /// Bit for bit, NaN like NaN.
  static void expect_same(const std::vector<double>& one, const std::vector<double>& other) {
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i)
      EXPECT_TRUE(one[i] == other[i] || (std::isnan(one[i]) && std::isnan(other[i]))) << i;
  }
};

}  // namespace kerf::test
