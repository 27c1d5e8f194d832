#include "atlas/atlas_answer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <stdexcept>

#include <fmt/format.h>

#include "atlas/atlas_rows.h"

namespace kerf::bench {
namespace {

/// The tile that each cell is in, of all axes together.
std::vector<std::uint32_t> tiles_of_rows(const std::vector<PartedRows>& parted,
                                         std::vector<std::uint8_t>& counts) {
  std::vector<std::uint32_t> tiles(counts.size(), 0);
  std::uint32_t stride = 1;
  for (const PartedRows& axis : parted) {
    for (std::size_t row = 0; row < tiles.size(); ++row) {
      if (axis.part[row] == in_no_part) {
        counts[row] = 0;
      } else {
        tiles[row] += stride * axis.part[row];
      }
    }
    stride *= static_cast<std::uint32_t>(axis.axis.parts());
  }
  return tiles;
}

void take(AtlasTile& tile, AtlasStatistic statistic, double number) {
  const bool is_first = tile.known++ == 0;
  switch (statistic) {
    case AtlasStatistic::smallest:
      tile.value = is_first ? number : std::min(tile.value, number);
      break;
    case AtlasStatistic::largest:
      tile.value = is_first ? number : std::max(tile.value, number);
      break;
    default:  // sums; of medians until they are known
      tile.value = is_first ? number : tile.value + number;
  }
}

double median_of(std::span<double> numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  if (numbers.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(numbers.begin(), middle)) / 2.0;
}

/// The numbers of each tile side by side, then the median of each.
void take_medians(const std::vector<double>& numbers, const std::vector<std::uint32_t>& tile_of,
                  const std::vector<std::uint8_t>& counts, std::vector<AtlasTile>& tiles) {
  std::vector<std::size_t> end(tiles.size() + 1, 0);
  for (std::size_t i = 0; i < tiles.size(); ++i) end[i + 1] = end[i] + tiles[i].known;
  std::vector<std::size_t> next(end.begin(), end.end() - 1);
  std::vector<double> sorted(end.back());
  for (std::size_t row = 0; row < numbers.size(); ++row)
    if (counts[row] != 0 && !std::isnan(numbers[row])) sorted[next[tile_of[row]]++] = numbers[row];
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (tiles[i].known > 0) tiles[i].value = median_of(std::span(sorted).subspan(end[i], tiles[i].known));
}

void require_few_tiles(const AtlasAnswer& answer) {
  std::size_t tiles = 1;
  for (const AtlasAxis& axis : answer.axes) {
    tiles *= axis.parts();
    if (tiles > AtlasQuestion::most_tiles)
      throw std::invalid_argument(fmt::format("more than {} tiles are no picture; part by less, or filter",
                                              AtlasQuestion::most_tiles));
  }
}

std::string unit_of(SweepAtlas& atlas, std::size_t table, const AtlasQuestion& question) {
  if (question.is_share()) return "1";
  const AtlasTable& of = atlas.tables().at(table);
  return of.columns[of.column_called(question.of)].unit;
}

/// Spread over all numbers, so that a threshold on it takes cells by chance, the same ones for ever.
std::uint64_t hash_of(std::uint64_t cell) {
  cell += 0x9e3779b97f4a7c15ULL;
  cell = (cell ^ (cell >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  cell = (cell ^ (cell >> 27U)) * 0x94d049bb133111ebULL;
  return cell ^ (cell >> 31U);
}

}  // namespace

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : fmt::format("{} [{}]", name, unit);
}

bool AtlasAxis::is_logarithmic() const {
  const std::vector<double>& numbers = names.empty() ? edges : values;
  if (numbers.size() < 3 || !(numbers.front() > 0.0) || !(numbers.back() > numbers.front())) return false;
  const double ratio = numbers[1] / numbers[0];
  const double steady = std::pow(ratio, static_cast<double>(numbers.size() - 1));
  return ratio > 1.0 && std::abs(std::log(steady) / std::log(numbers.back() / numbers.front()) - 1.0) < 0.05;
}

AtlasSpan span_of(SweepAtlas& atlas, std::size_t table, std::size_t column) {
  const AtlasColumn& about = atlas.tables().at(table).columns.at(column);
  AtlasSpan span;
  if (about.is_listed()) {
    span.known = atlas.tables()[table].cells();
    if (!about.values.empty()) {
      span.smallest = about.values.front();
      for (const double value : about.values)
        if (!std::isnan(value)) span.largest = value;
    }
    return span;
  }
  const auto values = atlas.values(table, column);
  for (const double number : values->numbers) {
    if (!std::isfinite(number)) continue;
    span.smallest = span.known == 0 ? number : std::min(span.smallest, number);
    span.largest = span.known == 0 ? number : std::max(span.largest, number);
    ++span.known;
  }
  return span;
}

AtlasAnswer answer(SweepAtlas& atlas, const AtlasQuestion& question) {
  const std::size_t table = atlas.table_called(question.table);
  const AtlasTable& of = atlas.tables()[table];
  AtlasAnswer answer{.axes = {}, .tiles = {}, .unit = unit_of(atlas, table, question), .all = {}};
  std::vector<PartedRows> parted;
  for (const std::string& column : question.by) {
    parted.push_back(parted_rows(atlas, table, column, question));
    answer.axes.push_back(parted.back().axis);
  }
  require_few_tiles(answer);
  std::vector<std::uint8_t> counts = rows_that_count(atlas, table, question.where);
  const std::vector<std::uint32_t> tile_of = tiles_of_rows(parted, counts);
  const std::vector<double> numbers = asked_numbers(atlas, table, question);
  answer.tiles.resize(std::transform_reduce(answer.axes.begin(), answer.axes.end(), std::size_t{1},
                                            std::multiplies<>(),
                                            [](const AtlasAxis& a) { return a.parts(); }));
  for (std::size_t row = 0; row < counts.size(); ++row) {
    if (counts[row] == 0) continue;
    AtlasTile& tile = answer.tiles[tile_of[row]];
    if (row < of.computed) {
      ++tile.computed;
      if (!std::isnan(numbers[row])) take(tile, question.statistic, numbers[row]);
    } else if (row < of.computed + of.failed.size()) {
      ++tile.failed;
    } else {
      ++tile.missing;
    }
  }
  for (AtlasTile& tile : answer.tiles) {
    answer.all.computed += tile.computed;
    answer.all.known += tile.known;
    answer.all.failed += tile.failed;
    answer.all.missing += tile.missing;
    if (question.is_share() || question.statistic == AtlasStatistic::mean) tile.value /= tile.known;
  }
  if (question.statistic == AtlasStatistic::median) take_medians(numbers, tile_of, counts, answer.tiles);
  return answer;
}

AtlasSample sample(SweepAtlas& atlas, const AtlasQuestion& question, const std::vector<std::string>& columns,
                   std::size_t most) {
  const std::size_t table = atlas.table_called(question.table);
  const AtlasTable& of = atlas.tables()[table];
  const std::vector<std::uint8_t> counts = rows_that_count(atlas, table, question.where);
  AtlasSample sample;
  sample.of = static_cast<std::size_t>(std::ranges::count(counts, 1));
  const double share = sample.of <= most ? 1.0 : static_cast<double>(most) / static_cast<double>(sample.of);
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < counts.size(); ++row)
    if (counts[row] != 0 && std::ldexp(static_cast<double>(hash_of(row)), -64) <= share) rows.push_back(row);
  for (const std::size_t row : rows)
    sample.state.emplace_back(row < of.computed                      ? ""
                              : row < of.computed + of.failed.size() ? "failed"
                                                                     : "missing");
  for (const std::string& name : columns) {
    const std::size_t column = of.column_called(name);
    const AtlasColumn& about = sample.columns.emplace_back(of.columns[column]);
    const auto values = atlas.values(table, column);
    std::vector<double>& taken = sample.values.emplace_back();
    for (const std::size_t row : rows) {
      if (about.is_listed()) {
        taken.push_back(values->codes[row]);
      } else {
        taken.push_back(row < values->numbers.size() ? values->numbers[row]
                                                     : std::numeric_limits<double>::quiet_NaN());
      }
    }
  }
  return sample;
}

}  // namespace kerf::bench
