#include "kernels/wide/exponential.h"

#include "kernels/wide/packs.h"

namespace kerf::fitting::wide {
namespace {

KERF_WIDE_PACKETS void run(Block& block, const models::Exponential<double>& law) {
  const double rate = law.exponent / law.thickness;
  for (std::size_t i = 0; i < block.padded; i += lanes) {
    const Pack x = load(&block.penetration[i]);
    const Bits touches = x > 0.0;
    const Pack growth = rate * x;
    const Pack share = where(touches, exp(growth));
    const Pack v = where(touches, load(&block.velocity[i]));
    store(&block.column[0][i], share);
    store(&block.column[1][i], where(touches, growth * share));
    store(&block.column[2][i], v);
    store(&block.column[3][i], all(1.0));
    store(&block.force[i], law.offset + (law.amplitude * share + law.viscosity * v));
  }
}

}  // namespace

void Exponential::fill(Block& block) const noexcept { run(block, law_); }

}  // namespace kerf::fitting::wide
