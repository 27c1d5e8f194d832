#include "kernels/wide/friction.h"

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

/// What a row's travel does to the state.
struct Decays {
  alignas(64) Block::Column sign;  ///< of the travel
  Block::Column loss;              ///< 1 - e
  Block::Column fading;            ///< e |dx| / xd
};

/// 1 - exp(-q), q >= 0: by its series where the difference would lose its digits.
[[gnu::always_inline]] inline Pack loss_of(const Pack& q, const Pack& left) {
  constexpr double few = 0.35;
  Pack series = all(1.0);
  for (int k = 13; k > 1; --k) series = 1.0 - q * series * (1.0 / k);
  return choose(q < few, q * series, 1.0 - left);
}

KERF_WIDE_PACKETS void decays_of(const Block& block, double before, double presliding, Decays& decays) {
  const Pack one = all(1.0);
  Pack last = all(before);
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack here = load(&block.penetration[i]);
    const Pack travel = here - one_later(last, here);
    last = here;
    const Bits forward = travel > 0.0;
    const Pack share = (forward ? travel : -travel) / presliding;
    const Pack left = exp(-share);
    store(&decays.sign[i], choose(forward, one, -one));
    store(&decays.loss[i], loss_of(share, left));
    store(&decays.fading[i], share * left);
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
  Decays decays{};
  decays_of(block, before_, law_.presliding, decays);
  before_ = block.penetration[block.count - 1];
  for (std::size_t i = 0; i < block.padded; ++i) {
    const double away = slip_ - decays.sign[i];
    slip_ -= away * decays.loss[i];
    slip_slope_ += away * decays.fading[i] - slip_slope_ * decays.loss[i];
    block.column[3][i] = slip_;
    block.column[4][i] = slip_slope_;
  }
  slip_ = block.column[3][block.count - 1];
  slip_slope_ = block.column[4][block.count - 1];
  write(block, law_);
}

}  // namespace kerf::fitting::wide
