#pragma once

#include <cstddef>
#include <span>

namespace kerf::bench {

/// Rows [begin, end).
struct RowSpan {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Whether rows lie in any of some spans, which increase and do not overlap: quickly for rows that increase.
class InSpans {
 public:
  explicit InSpans(std::span<const RowSpan> spans) : spans_(spans) {}

  [[nodiscard]] bool operator()(std::size_t row) {
    if (at_ > 0 && row < spans_[at_ - 1].end) at_ = 0;
    while (at_ < spans_.size() && row >= spans_[at_].end) ++at_;
    return at_ < spans_.size() && row >= spans_[at_].begin;
  }

 private:
  std::span<const RowSpan> spans_;
  std::size_t at_ = 0;  ///< the first one that does not end before the last row asked for
};

}  // namespace kerf::bench
