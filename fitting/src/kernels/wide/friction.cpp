#include "kernels/wide/friction.h"

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

/// What a row's travel does to the state.
struct Decays {
  alignas(64) Block::Column sign;  ///< of the travel
  Block::Column left;              ///< e
  Block::Column gain;              ///< (1 - e) sgn dx
  Block::Column fading;            ///< e |dx| / xd
};

KERF_WIDE_PACKETS void decays_of(const Block& block, double before, double presliding, Decays& decays) {
  const Pack one = all(1.0);
  Pack last = all(before);
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack here = load(&block.penetration[i]);
    const Pack travel = here - one_later(last, here);
    last = here;
    const Bits forward = travel > 0.0;
    const Pack share = (forward ? travel : -travel) / presliding;
    const Pack sign = choose(forward, one, -one);
    const Decay of = decay(share);
    store(&decays.sign[i], sign);
    store(&decays.left[i], of.left);
    store(&decays.gain[i], sign * of.loss);
    store(&decays.fading[i], share * of.left);
  }
}

KERF_WIDE_PACKETS void write(Block& block, const models::Friction<double>& law) {
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack x = load(&block.penetration[i]);
    const Pack v = load(&block.velocity[i]);
    store(&block.column[0][i], all(1.0));
    store(&block.column[1][i], x);
    store(&block.column[2][i], v);
    store(&block.force[i],
          law.offset + law.stiffness * x + law.viscosity * v + law.coulomb * load(&block.column[3][i]));
  }
}

}  // namespace

void Friction::fill(Block& block) noexcept {
  if (!started_) before_ = block.penetration[0];
  started_ = true;
  Decays decays;  // NOLINT(cppcoreguidelines-pro-type-member-init): as far as it is read
  decays_of(block, before_, law_.presliding, decays);
  before_ = block.penetration[block.count - 1];
  // Two rows a step: the second does not wait for the first.
  double slip = slip_;
  double slope = slip_slope_;
  for (std::size_t i = 0; i < block.padded; i += 2) {
    const double left = decays.left[i];
    const double left_2 = decays.left[i + 1];
    const double both = left * left_2;
    const double gain_2 = decays.gain[i] * left_2 + decays.gain[i + 1];
    const double grown = (slip - decays.sign[i]) * decays.fading[i];
    const double slip_1 = slip * left + decays.gain[i];
    slip = slip * both + gain_2;
    const double grown_2 = (slip_1 - decays.sign[i + 1]) * decays.fading[i + 1];
    block.column[3][i] = slip_1;
    block.column[3][i + 1] = slip;
    block.column[4][i] = slope * left + grown;
    slope = slope * both + (grown * left_2 + grown_2);
    block.column[4][i + 1] = slope;
  }
  slip_ = block.column[3][block.count - 1];
  slip_slope_ = block.column[4][block.count - 1];
  write(block, law_);
}

}  // namespace kerf::fitting::wide
