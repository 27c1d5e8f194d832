#include "prepare/score.h"

#include <algorithm>
#include <cmath>

#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

std::size_t shared_rows(const RowSpan& a, const RowSpan& b) {
  const std::size_t begin = std::max(a.begin, b.begin);
  const std::size_t end = std::min(a.end, b.end);
  return end > begin ? end - begin : 0;
}

ErrorOf summary_of(const std::vector<double>& errors) {
  if (errors.empty()) return {};
  std::vector<double> sizes;
  for (const double error : errors) sizes.push_back(std::abs(error));
  return {.bias_s = quantile(errors, 0.5),
          .median_s = quantile(sizes, 0.5),
          .percentile_90_s = quantile(sizes, 0.9)};
}

}  // namespace

ContactScore score_contacts(std::span<const RowSpan> detected, std::span<const RowSpan> labelled,
                            std::span<const double> time_s) {
  ContactScore score{.labelled = labelled.size(), .detected = detected.size()};
  std::vector<const RowSpan*> match(labelled.size(), nullptr);
  std::size_t shared = 0;
  std::size_t detected_rows = 0;
  std::size_t labelled_rows = 0;
  for (const RowSpan& label : labelled) labelled_rows += label.end - label.begin;
  for (const RowSpan& span : detected) {
    detected_rows += span.end - span.begin;
    std::size_t best = labelled.size();
    std::size_t most = 0;
    for (std::size_t i = 0; i < labelled.size(); ++i) {
      const std::size_t rows = shared_rows(span, labelled[i]);
      shared += rows;
      if (rows <= most) continue;
      most = rows;
      best = i;
    }
    if (best == labelled.size()) {
      ++score.false_ones;
    } else if (match[best] == nullptr) {
      match[best] = &span;
    } else {
      ++score.split_up;
      if (most > shared_rows(*match[best], labelled[best])) match[best] = &span;
    }
  }
  std::vector<double> begin_errors;
  std::vector<double> end_errors;
  for (std::size_t i = 0; i < labelled.size(); ++i) {
    if (match[i] == nullptr) continue;
    ++score.found;
    begin_errors.push_back(time_s[match[i]->begin] - time_s[labelled[i].begin]);
    end_errors.push_back(time_s[match[i]->end - 1] - time_s[labelled[i].end - 1]);
  }
  score.missed = score.labelled - score.found;
  score.begin = summary_of(begin_errors);
  score.end = summary_of(end_errors);
  const auto share = [&](std::size_t of) {
    return of > 0 ? static_cast<double>(shared) / static_cast<double>(of) : 0.0;
  };
  score.precision = share(detected_rows);
  score.recall = share(labelled_rows);
  const double both = static_cast<double>(detected_rows + labelled_rows);
  score.f1 = both > 0.0 ? 2.0 * static_cast<double>(shared) / both : 0.0;
  return score;
}

std::vector<RowSpan> labelled_spans(std::span<const double> labels, double value) {
  std::vector<RowSpan> spans;
  for (std::size_t row = 0; row < labels.size(); ++row) {
    if (labels[row] != value) continue;
    if (row == 0 || labels[row - 1] != value) spans.push_back({.begin = row, .end = row});
    spans.back().end = row + 1;
  }
  return spans;
}

}  // namespace kerf::bench
