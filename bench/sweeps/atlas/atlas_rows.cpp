#include "atlas/atlas_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// A column as numbers, of the computed cells.
std::vector<double> numbers_of(SweepAtlas& atlas, std::size_t table, const std::string& name) {
  const AtlasTable& of = atlas.tables().at(table);
  const std::size_t column = of.column_called(name);
  const AtlasColumn& about = of.columns[column];
  if (about.is_text()) throw std::invalid_argument(fmt::format("{} is a text, and no number", name));
  const auto values = atlas.values(table, column);
  std::vector<double> numbers;
  if (!about.is_listed()) {
    numbers.assign(values->numbers.begin(),
                   values->numbers.begin() + static_cast<std::ptrdiff_t>(of.computed));
    return numbers;
  }
  numbers.resize(of.computed);
  for (std::size_t row = 0; row < of.computed; ++row) numbers[row] = about.values[values->codes[row]];
  return numbers;
}

/// Of each value of a listed input 1 where a filter lets it through.
std::vector<std::uint8_t> values_that_count(const AtlasColumn& about, const AtlasFilter& filter) {
  for (const std::string& value : filter.among) {
    if (std::ranges::count(about.texts, value) == 0)
      throw std::invalid_argument(fmt::format("{} has no value '{}' in this sweep", about.name, value));
  }
  std::vector<std::uint8_t> counted(about.texts.size(), 1);
  for (std::size_t i = 0; i < counted.size(); ++i) {
    // A text stands at its place, as parallel axes have it.
    const double number = about.values.empty() ? static_cast<double>(i) : about.values[i];
    const bool counts = filter.among.empty() ? number >= filter.lower && number <= filter.upper
                                             : std::ranges::count(filter.among, about.texts[i]) > 0;
    counted[i] = counts ? 1 : 0;
  }
  return counted;
}

/// A listed axis, and of each value its part.
struct ListedParts {
  AtlasAxis axis;
  std::vector<std::uint32_t> part_of;
};
ListedParts listed_parts(const AtlasColumn& about, const AtlasQuestion& question) {
  std::vector<std::uint8_t> counted(about.texts.size(), 1);
  for (const AtlasFilter& filter : question.where) {
    if (filter.column != about.name) continue;
    const std::vector<std::uint8_t> by_this = values_that_count(about, filter);
    for (std::size_t i = 0; i < counted.size(); ++i) counted[i] &= by_this[i];
  }
  ListedParts listed{
      .axis = {.column = about.name, .unit = about.unit, .names = {}, .values = {}, .edges = {}},
      .part_of = std::vector<std::uint32_t>(counted.size(), in_no_part)};
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (counted[i] == 0) continue;
    listed.part_of[i] = static_cast<std::uint32_t>(listed.axis.names.size());
    listed.axis.names.push_back(about.texts[i]);
    if (!about.values.empty()) listed.axis.values.push_back(about.values[i]);
  }
  if (listed.axis.names.empty())
    throw std::invalid_argument(fmt::format("the filters leave no value of {}", about.name));
  return listed;
}

bool holds(AtlasCondition::Relation relation, double left, double right) {
  switch (relation) {
    case AtlasCondition::Relation::less:
      return left < right;
    case AtlasCondition::Relation::at_most:
      return left <= right;
    case AtlasCondition::Relation::greater:
      return left > right;
    case AtlasCondition::Relation::at_least:
      break;
  }
  return left >= right;
}

std::vector<double> edges_of(const AtlasSpan& span, std::size_t bins) {
  const bool logarithmic = span.smallest > 0.0 && span.largest / span.smallest > 100.0;
  std::vector<double> edges(bins + 1);
  for (std::size_t i = 0; i <= bins; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(bins);
    edges[i] = logarithmic ? span.smallest * std::pow(span.largest / span.smallest, share)
                           : span.smallest + (span.largest - span.smallest) * share;
  }
  edges.back() = span.largest;
  return edges;
}

}  // namespace

std::vector<std::uint8_t> rows_that_count(SweepAtlas& atlas, std::size_t table,
                                          const std::vector<AtlasFilter>& filters) {
  const AtlasTable& of = atlas.tables().at(table);
  std::vector<std::uint8_t> counts(of.cells(), 1);
  for (const AtlasFilter& filter : filters) {
    const std::size_t column = of.column_called(filter.column);
    const AtlasColumn& about = of.columns[column];
    const auto values = atlas.values(table, column);
    if (about.is_listed()) {
      const std::vector<std::uint8_t> counted = values_that_count(about, filter);
      for (std::size_t row = 0; row < counts.size(); ++row) counts[row] &= counted[values->codes[row]];
      continue;
    }
    if (!filter.among.empty())
      throw std::invalid_argument(
          fmt::format("the values of {} are not listed; expected [from, to]", filter.column));
    const std::vector<double>& numbers = values->numbers;
    for (std::size_t row = 0; row < counts.size(); ++row) {
      const bool within =
          row < numbers.size() && numbers[row] >= filter.lower && numbers[row] <= filter.upper;
      counts[row] &= within ? 1 : 0;
    }
  }
  return counts;
}

PartedRows parted_rows(SweepAtlas& atlas, std::size_t table, const std::string& name,
                       const AtlasQuestion& question) {
  const AtlasTable& of = atlas.tables().at(table);
  const std::size_t column = of.column_called(name);
  const AtlasColumn& about = of.columns[column];
  PartedRows parted{.axis = {.column = name, .unit = about.unit, .names = {}, .values = {}, .edges = {}},
                    .part = std::vector<std::uint32_t>(of.cells(), in_no_part)};
  const auto values = atlas.values(table, column);
  if (about.is_listed()) {
    ListedParts listed = listed_parts(about, question);
    parted.axis = std::move(listed.axis);
    for (std::size_t row = 0; row < parted.part.size(); ++row)
      parted.part[row] = listed.part_of[values->codes[row]];
    return parted;
  }
  const AtlasSpan span = span_of(atlas, table, column);
  if (span.known == 0) throw std::invalid_argument(fmt::format("no cell has a number in {}", name));
  parted.axis.edges = edges_of(span, span.smallest < span.largest ? question.bins : 1);
  const std::vector<double>& edges = parted.axis.edges;
  for (std::size_t row = 0; row < values->numbers.size(); ++row) {
    const double number = values->numbers[row];
    if (!std::isfinite(number)) continue;
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, number);
    parted.part[row] = static_cast<std::uint32_t>(above - edges.begin() - 1);
  }
  return parted;
}

std::vector<double> asked_numbers(SweepAtlas& atlas, std::size_t table, const AtlasQuestion& question) {
  if (!question.is_share()) return numbers_of(atlas, table, question.of);
  std::vector<double> all(atlas.tables().at(table).computed, 1.0);
  for (const AtlasCondition& condition : question.share) {
    const std::vector<double> left = numbers_of(atlas, table, condition.column);
    std::vector<double> right;
    if (!condition.other.empty()) right = numbers_of(atlas, table, condition.other);
    for (std::size_t row = 0; row < all.size(); ++row) {
      const double against = right.empty() ? condition.number : right[row];
      // One that is not known makes the whole unknown, even where another condition fails.
      if (std::isnan(left[row]) || std::isnan(against)) {
        all[row] = unknown;
      } else if (!std::isnan(all[row]) && !holds(condition.relation, left[row], against)) {
        all[row] = 0.0;
      }
    }
  }
  return all;
}

}  // namespace kerf::bench
