#include "fracture/deformed_rows.h"

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

static_assert(DeformedRows::in_a_packet == lanes);

KERF_WIDE_PACKETS void run(const std::vector<DeformedRows::Packet>& rows, double amplitude, double rate,
                           double shift, DeformedRows::Sums& into) {
  Pack squares = all(0.0);
  Pack s0 = all(0.0), s1 = all(0.0), s2 = all(0.0);
  Pack n00 = all(0.0), n01 = all(0.0), n02 = all(0.0), n11 = all(0.0), n12 = all(0.0), n22 = all(0.0);
  for (const DeformedRows::Packet& row : rows) {
    const Pack moves = load(row.moves.data());
    const Pack growth = rate * (load(row.depth.data()) - moves * shift);
    const Pack force = amplitude * exp(growth);
    const Pack residual = force - load(row.force.data());
    const Pack by_rate = force * growth;
    const Pack by_shift = -rate * (force * moves);
    const Pack weight = load(row.weight.data());
    const Pack weighed = weight * force;
    const Pack weighed_rate = weight * by_rate;
    const Pack weighed_shift = weight * by_shift;
    squares += weight * residual * residual;
    s0 += weighed * residual;
    s1 += weighed_rate * residual;
    s2 += weighed_shift * residual;
    n00 += weighed * force;
    n01 += weighed * by_rate;
    n02 += weighed * by_shift;
    n11 += weighed_rate * by_rate;
    n12 += weighed_rate * by_shift;
    n22 += weighed_shift * by_shift;
  }
  into.squares = sum(squares);
  into.score = {sum(s0), sum(s1), sum(s2)};
  into.normal = {sum(n00), sum(n01), sum(n02), sum(n11), sum(n12), sum(n22)};
}

}  // namespace

DeformedRows::Sums DeformedRows::sums(double amplitude_n, double rate_per_m, double shift_m) const noexcept {
  Sums sums;
  run(packets_, amplitude_n, rate_per_m, shift_m, sums);
  return sums;
}

}  // namespace kerf::fitting::wide
