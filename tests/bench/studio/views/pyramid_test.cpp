#include "views/rows/pyramid.h"

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// A column with noise, spikes, NaN, infinities and whole stretches of nothing.
std::vector<double> rough_column(std::size_t rows, std::mt19937& random) {
  std::vector<double> values(rows);
  std::normal_distribution<double> noise;
  for (double& value : values) value = noise(random);
  for (std::size_t spike = 0; spike < rows / 200 + 1 && rows > 0; ++spike) {
    const double values_of_spikes[]{1e6, -1e6, 1e-320, 1.0 / 3e8, nothing, infinity, -infinity, 1e39, -1e300};
    values[random() % rows] = values_of_spikes[random() % 9];
  }
  if (rows > 1000) {
    const std::size_t begin = random() % (rows - 500);
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(begin), 400, nothing);
  }
  return values;
}

MinMaxPyramid pyramid_of(const std::vector<double>& values) {
  PyramidBuilder builder(values.size(), 1);
  for (std::size_t at = 0; at < values.size(); at += PyramidBuilder::rows_at_once) {
    builder.add(std::span(values).subspan(at, std::min(PyramidBuilder::rows_at_once, values.size() - at)));
  }
  return std::move(builder).finish()[0];
}

MinMaxPyramid::ReadRows reader_of(const std::vector<double>& values) {
  return [&values](std::uint64_t first, std::span<double> rows) {
    ASSERT_LE(first + rows.size(), values.size());
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(first), rows.size(), rows.begin());
  };
}

/// What a column of a view must be, found the plain way.
void expect_column(const std::vector<double>& values, std::uint64_t first, std::uint64_t end, float smallest,
                   float largest) {
  double least = infinity;
  double most = -infinity;
  for (std::uint64_t row = first; row < end; ++row) {
    if (!std::isfinite(values[row])) continue;
    least = std::min(least, values[row]);
    most = std::max(most, values[row]);
  }
  if (least > most) {
    EXPECT_TRUE(std::isnan(smallest) && std::isnan(largest)) << first << " to " << end;
    return;
  }
  // Outward, and by less than one step of a float.
  EXPECT_LE(static_cast<double>(smallest), least);
  EXPECT_GT(static_cast<double>(std::nextafter(smallest, std::numeric_limits<float>::infinity())), least);
  EXPECT_GE(static_cast<double>(largest), most);
  EXPECT_LT(static_cast<double>(std::nextafter(largest, -std::numeric_limits<float>::infinity())), most);
}

void expect_view(const MinMaxPyramid& pyramid, const std::vector<double>& values, std::uint64_t first,
                 std::uint64_t end, std::size_t columns) {
  const auto boundaries = column_boundaries(first, end, columns);
  const TraceView::Extremes view = pyramid.view(first, end, columns, reader_of(values));
  ASSERT_EQ(view.smallest.size(), boundaries.empty() ? 0 : boundaries.size() - 1);
  ASSERT_EQ(view.largest.size(), view.smallest.size());
  for (std::size_t i = 0; i < view.smallest.size(); ++i) {
    expect_column(values, boundaries[i], boundaries[i + 1], view.smallest[i], view.largest[i]);
  }
}

TEST(MinMaxPyramid, GivesTheExtremesOfTheRowsAtAnyZoom) {
  std::mt19937 random(11);
  for (const std::size_t rows : {1U, 2U, 63U, 64U, 65U, 511U, 512U, 513U, 4095U, 4097U, 40'000U}) {
    const auto values = rough_column(rows, random);
    const MinMaxPyramid pyramid = pyramid_of(values);
    expect_view(pyramid, values, 0, rows, 7);
    expect_view(pyramid, values, 0, rows, rows);
    for (int turn = 0; turn < 60; ++turn) {
      const std::uint64_t first = random() % rows;
      const std::uint64_t end = first + random() % (rows - first + 1);
      expect_view(pyramid, values, first, end, 1 + random() % 300);
    }
  }
}

TEST(MinMaxPyramid, OfNoRowsHasNoColumns) {
  const MinMaxPyramid pyramid = pyramid_of({});
  EXPECT_TRUE(pyramid.view(0, 0, 100, {}).smallest.empty());
  EXPECT_THROW((void)pyramid.view(0, 1, 1, {}), std::out_of_range);
}

TEST(MinMaxPyramid, ReadsNoRowWhereBucketsCoverTheColumns) {
  std::mt19937 random(3);
  const auto values = rough_column(10'000, random);
  const std::vector<std::uint64_t> boundaries{0, 64, 640, 6400, 9984, 10'000};
  const auto view = pyramid_of(values).view(boundaries, [](auto, auto) { FAIL() << "a row was read"; });
  ASSERT_EQ(view.smallest.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    expect_column(values, boundaries[i], boundaries[i + 1], view.smallest[i], view.largest[i]);
  }
}

TEST(MinMaxPyramid, ReadsOnlyTheRowsAtTheEdgesOfAWideView) {
  const std::vector<double> values(640'000, 1.0);
  std::uint64_t rows_read = 0;
  (void)pyramid_of(values).view(1, values.size() - 1, 10, [&](auto, std::span<double> rows) {
    rows_read += rows.size();
    std::fill(rows.begin(), rows.end(), 1.0);
  });
  EXPECT_GT(rows_read, 0U);
  EXPECT_LE(rows_read, 64U * 2 * 10);
}

TEST(MinMaxPyramid, OfAxesSideBySideIsThatOfEachAlone) {
  std::mt19937 random(5);
  for (std::size_t width = 1; width <= 6; ++width) {
    const std::size_t rows = PyramidBuilder::rows_at_once + 200;
    const auto values = rough_column(rows * width, random);
    PyramidBuilder builder(rows, width);
    const std::size_t first = PyramidBuilder::rows_at_once * width;
    builder.add(std::span(values).first(first));
    builder.add(std::span(values).subspan(first));
    const auto pyramids = std::move(builder).finish();
    ASSERT_EQ(pyramids.numbers().size(), width * MinMaxPyramid::size_of(rows));
    for (std::size_t column = 0; column < width; ++column) {
      std::vector<double> alone;
      for (std::size_t i = column; i < values.size(); i += width) alone.push_back(values[i]);
      const auto expected = pyramid_of(alone);
      for (std::size_t i = 0; i < expected.numbers().size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::uint32_t>(pyramids[column].numbers()[i]) & 0x7fffffffU,
                  std::bit_cast<std::uint32_t>(expected.numbers()[i]) & 0x7fffffffU);
      }
      expect_view(pyramids[column], alone, 0, rows, 50);
      const auto boundaries = column_boundaries(0, rows, 50);
      const auto view = extremes_of_rows(values, width, column, 0, boundaries);
      for (std::size_t i = 0; i < 50; ++i) {
        expect_column(alone, boundaries[i], boundaries[i + 1], view.smallest[i], view.largest[i]);
      }
    }
  }
}

TEST(MinMaxPyramid, IsBuiltOfAllItsRowsInOrder) {
  PyramidBuilder builder(100, 1);
  const std::vector<double> values(101, 0.0);
  EXPECT_THROW(builder.add(values), std::invalid_argument);
  builder.add(std::span(values).first(10));
  EXPECT_THROW(builder.add(std::span(values).first(10)), std::invalid_argument);
  EXPECT_THROW((void)std::move(builder).finish(), std::logic_error);
  const std::vector<float> numbers(3);
  EXPECT_THROW(MinMaxPyramid(100, numbers, nullptr), std::invalid_argument);
}

TEST(Columns, AreOfEqualWidthAndNeverEmpty) {
  EXPECT_THAT(column_boundaries(10, 20, 4), testing::ElementsAre(10, 12, 15, 17, 20));
  EXPECT_THAT(column_boundaries(10, 12, 4000), testing::ElementsAre(10, 11, 12));
  EXPECT_TRUE(column_boundaries(10, 10, 4).empty());
  const auto far = column_boundaries(0, UINT64_MAX, 1000);
  EXPECT_TRUE(std::is_sorted(far.begin(), far.end()));
  EXPECT_EQ(far.back(), UINT64_MAX);
}

}  // namespace
}  // namespace kerf::bench
