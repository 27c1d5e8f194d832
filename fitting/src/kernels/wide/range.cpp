#include "kernels/wide/range.h"

#include <algorithm>

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

KERF_WIDE_PACKETS Range of(const double* values, std::size_t count) {
  Range range{.least = values[0], .most = values[0], .is_finite = true};
  Pack least = all(values[0]);
  Pack most = least;
  Pack nothing{};  // but for what is not finite
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Pack pack = load(values + i);
    least = pack < least ? pack : least;
    most = pack > most ? pack : most;
    nothing += 0.0 * pack;
  }
  double rest = sum(nothing);
  for (; i < count; ++i) {
    range.least = std::min(range.least, values[i]);
    range.most = std::max(range.most, values[i]);
    rest += 0.0 * values[i];
  }
  for (std::size_t k = 0; k < lanes; ++k) {
    range.least = std::min(range.least, least[k]);
    range.most = std::max(range.most, most[k]);
  }
  range.is_finite = rest == 0.0;
  return range;
}

}  // namespace

Range range_of(std::span<const double> values) noexcept { return of(values.data(), values.size()); }

}  // namespace kerf::fitting::wide
