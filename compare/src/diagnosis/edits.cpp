#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "diagnosis/pair.h"
#include "diagnosis/rows_by_time.h"

namespace kerf::compare {
namespace {

constexpr std::size_t most_edits = 200;
constexpr std::size_t enough_rows = 4;  ///< that must be the same after an edit
constexpr std::size_t most_other_rows = 5;
constexpr std::size_t looked_ahead = 4000;  ///< rows by which candidates are told apart

class RowMatching {
 public:
  RowMatching(const Series& expected, const Series& got) : expected_(expected), got_(got) {
    add_columns(expected.channels, got.channels);
    // Rows of a law without contact look alike, those of its motion do not.
    if (expected.positions.size() == got.positions.size()) add_columns(expected.positions, got.positions);
  }

  /// False if the runs are not the same but for rows that are missing or added.
  bool run() {
    const std::size_t n = expected_.rows();
    const std::size_t m = got_.rows();
    std::size_t i = 0;
    std::size_t j = 0;
    while (i < n && j < m) {
      if (same(i, j)) {
        matched.expected.push_back(i++);
        matched.got.push_back(j++);
        continue;
      }
      if (edits.size() + others == most_edits) return false;
      const auto edit = next_edit(i, j);
      if (!edit) return false;
      if (edit->lost + edit->added == 0) {  // other, and none too many or too few
        ++others;
        matched.expected.push_back(i++);
        matched.got.push_back(j++);
        continue;
      }
      edits.push_back(*edit);
      i += edit->lost;
      j += edit->added;
    }
    expected_left = n - i;
    got_left = m - j;
    matched.edits = edits.size();
    return true;
  }

  MatchedRows matched;
  std::vector<Edit> edits;
  std::size_t others = 0;         ///< rows with a partner that is not the same
  std::size_t expected_left = 0;  ///< rows at the end without a partner
  std::size_t got_left = 0;

  [[nodiscard]] bool same(std::size_t i, std::size_t j) const {
    return std::ranges::all_of(
        columns_, [&](const Column& one) { return std::abs(one.expected[i] - one.got[j]) <= one.tiny; });
  }
  [[nodiscard]] bool same_got(std::size_t j, std::size_t k) const {
    return std::ranges::all_of(
        columns_, [&](const Column& one) { return std::abs(one.got[j] - one.got[k]) <= one.tiny; });
  }

 private:
  struct Column {
    const double* expected;
    const double* got;
    double tiny;
  };

  void add_columns(const std::vector<Channel>& expected, const std::vector<Channel>& got) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      double peak = 0.0;
      for (const double one : expected[i].value) peak = std::max(peak, std::abs(one));
      columns_.push_back({expected[i].value.data(), got[i].value.data(), 1e-7 * peak});
    }
  }

  [[nodiscard]] std::size_t same_from(std::size_t i, std::size_t j) const {
    std::size_t count = 0;
    while (count < looked_ahead && i + count < expected_.rows() && j + count < got_.rows() &&
           same(i + count, j + count))
      ++count;
    return count;
  }

  [[nodiscard]] std::optional<Edit> next_edit(std::size_t i, std::size_t j) const {
    const std::size_t n = expected_.rows();
    const std::size_t m = got_.rows();
    const std::size_t most = std::max<std::size_t>(64, (n > m ? n - m : m - n) + 8);
    Edit best;
    std::size_t longest = 0;
    for (std::size_t count = 1; count <= most; ++count) {
      for (const bool lost : {true, false}) {
        const std::size_t at_i = i + (lost ? count : 0);
        const std::size_t at_j = j + (lost ? 0 : count);
        if (at_i > n || at_j > m) continue;
        const std::size_t run = same_from(at_i, at_j);
        // To the end of either, after some rows that are the same, or right away where the other is longer.
        const bool to_the_end = at_i + run == n || at_j + run == m;
        if (run < enough_rows && !(to_the_end && run >= 3)) continue;
        if (run <= longest) continue;
        longest = run;
        best = {.expected_row = i, .got_row = j, .lost = lost ? count : 0, .added = lost ? 0 : count};
      }
    }
    for (std::size_t count = 1; count <= most_other_rows; ++count) {
      const std::size_t run = same_from(i + count, j + count);
      if (run >= std::max(longest, enough_rows) || i + count >= n || j + count >= m) return Edit{};
    }
    if (longest == 0) return {};
    best.first = best.expected_row;
    for (std::size_t back = 1; back <= std::min(best.expected_row, best.got_row); ++back) {
      const std::size_t at_i = best.expected_row - back + best.lost;
      const std::size_t at_j = best.got_row - back + best.added;
      if (!same(at_i, at_j)) break;
      best.first = best.expected_row - back;
    }
    narrow_by_time(best);
    return best;
  }

  /// The clock of a run that lost a row goes on over it.
  void narrow_by_time(Edit& edit) const {
    if (edit.lost == 0 || edit.first == edit.expected_row || got_.time_s.empty() || expected_.time_s.empty())
      return;
    const double period_s = expected_.period();
    for (std::size_t row = edit.first; row <= edit.expected_row; ++row) {
      const std::size_t j = edit.got_row - (edit.expected_row - row);
      if (j == 0 || got_.time_s[j] - got_.time_s[j - 1] < 1.5 * period_s) continue;
      edit.first = row;
      edit.expected_row = row;
      return;
    }
  }

  const Series& expected_;
  const Series& got_;
  std::vector<Column> columns_;
};

/// The last row that may be meant: of samples that are there twice the first of those that were.
std::size_t last_row(const Edit& edit) {
  return std::max(edit.first, edit.expected_row - std::min(edit.added, edit.expected_row));
}

/// At a tick, or between two that nobody can tell apart. A sample that is there twice is meant by either.
std::string place_of(const Edit& edit) {
  if (edit.first == last_row(edit)) return fmt::format("at tick {}", edit.first);
  return fmt::format("between ticks {} and {}, which look the same", edit.first, last_row(edit));
}

std::string samples(std::size_t count) {
  return count == 1 ? std::string("a sample is") : fmt::format("{} samples are", count);
}

std::vector<std::size_t> differing_channels(const std::vector<ForcePair>& pairs) {
  std::vector<std::size_t> channels;
  for (const ForcePair& one : pairs) {
    if (one.differs) channels.push_back(one.channel);
  }
  return channels;
}

/// Edits of one kind as a finding.
void add_edits(const std::vector<Edit>& edits, Change change, const char* what, const Finding& like,
               Findings& found) {
  if (edits.empty()) return;
  std::size_t count = 0;
  for (const Edit& one : edits) count += one.lost + one.added;
  Finding finding = like;
  finding.change = change;
  finding.sentence = fmt::format("{} {}, {}", samples(count), what, place_of(edits.front()));
  for (std::size_t i = 1; i < std::min<std::size_t>(edits.size(), 4); ++i)
    finding.sentence += fmt::format("; {}", place_of(edits[i]));
  if (edits.size() > 4) finding.sentence += fmt::format("; and at {} places more", edits.size() - 4);
  finding.numbers = {{"count", static_cast<double>(count)},
                     {"row", static_cast<double>(last_row(edits.front()))},
                     {"first_row", static_cast<double>(edits.front().first)},
                     {"places", static_cast<double>(edits.size())}};
  found.push_back(std::move(finding));
}

/// What rows with a partner leave of the difference of all rows by their number.
double left_in(const MatchedRows& rows, const Series& expected, const Series& got,
               const std::vector<ForcePair>& pairs) {
  double left = 0.0;
  double all = 0.0;
  for (const ForcePair& pair : pairs) {
    for (std::size_t i = 0; i < rows.expected.size(); ++i) {
      const double rest = got.channels[pair.channel].value[rows.got[i]] -
                          expected.channels[pair.channel].value[rows.expected[i]];
      left += rest * rest;
    }
    for (const double one : pair.difference) all += one * one;
  }
  return all > 0.0 ? std::sqrt(left / all) : 0.0;
}

/// Where the forces are not alike the times tell of rows that are missing.
void find_edits_by_time(const Series& expected, const Series& got, const std::vector<ForcePair>& pairs,
                        Findings& found) {
  if (expected.rows() == got.rows()) return;
  const auto rows = matched_by_time(expected, got);
  if (!rows) return;
  std::vector<Edit> lost;
  std::vector<Edit> inserted;
  for (const Edit& one : edits_of(*rows)) (one.lost > 0 ? lost : inserted).push_back(one);
  const Finding like{.channels = differing_channels(pairs),
                     .remainder = left_in(*rows, expected, got, pairs)};
  add_edits(lost, Change::lost, "missing", like, found);
  add_edits(inserted, Change::inserted, "there that nobody expects", like, found);
}

}  // namespace

void find_edits(const Series& expected, const Series& got, const std::vector<ForcePair>& pairs,
                Findings& found) {
  RowMatching matching(expected, got);
  if (!matching.run()) {
    find_edits_by_time(expected, got, pairs, found);
    return;
  }
  std::vector<Edit> lost;
  std::vector<Edit> doubled;
  std::vector<Edit> inserted;
  for (const Edit& one : matching.edits) {
    if (one.lost > 0) {
      lost.push_back(one);
      continue;
    }
    bool twice = one.got_row > 0;
    for (std::size_t i = 0; twice && i < one.added; ++i)
      twice =
          matching.same_got(one.got_row + i, one.got_row - 1) ||
          (one.got_row + i >= one.added && matching.same_got(one.got_row + i, one.got_row + i - one.added));
    (twice ? doubled : inserted).push_back(one);
  }
  const Finding like{
      .channels = differing_channels(pairs),
      .remainder = matching.others > 0 ? left_in(matching.matched, expected, got, pairs) : 0.0};
  add_edits(lost, Change::lost, "missing", like, found);
  add_edits(doubled, Change::doubled, "there twice", like, found);
  add_edits(inserted, Change::inserted, "there that nobody expects", like, found);
  if (!matching.edits.empty() || expected.rows() == got.rows()) return;
  found.push_back({.change = matching.expected_left > 0 ? Change::lost : Change::inserted,
                   .channels = like.channels,
                   .remainder = like.remainder,
                   .sentence = matching.expected_left > 0
                                   ? "what is there is the same: the end is missing"
                                   : "what is expected is the same: there is more after it",
                   .numbers = {{"count", static_cast<double>(matching.expected_left + matching.got_left)},
                               {"row", static_cast<double>(std::min(expected.rows(), got.rows()))},
                               {"first_row", static_cast<double>(std::min(expected.rows(), got.rows()))},
                               {"places", 1.0}}});
}

std::optional<MatchedRows> matched_rows(const Series& expected, const Series& got) {
  RowMatching matching(expected, got);
  if (!matching.run()) return matched_by_time(expected, got);
  if (matching.edits.empty()) return {};
  return std::move(matching.matched);
}

Series rows_of(const Series& series, const std::vector<std::size_t>& rows) {
  Series some{.period_s = series.period_s};
  const auto take = [&](const std::vector<double>& all) {
    std::vector<double> chosen;
    chosen.reserve(rows.size());
    for (const std::size_t row : rows) chosen.push_back(all[row]);
    return chosen;
  };
  if (!series.time_s.empty()) some.time_s = take(series.time_s);
  const auto take_columns = [&](const std::vector<Channel>& from, std::vector<Channel>& to) {
    for (const Channel& one : from)
      to.push_back({.name = one.name, .unit = one.unit, .value = take(one.value)});
  };
  take_columns(series.channels, some.channels);
  take_columns(series.positions, some.positions);
  take_columns(series.velocities, some.velocities);
  return some;
}

}  // namespace kerf::compare
