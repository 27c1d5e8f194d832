#include <cmath>
#include <stdexcept>

#include "fuzz/target.h"
#include "laws/law_file.h"

namespace kerf::fuzz {
namespace {

/// A law that is read is written so that it reads the same, and renders.
void fuzz_law(Bytes bytes) {
  bench::LawFile law{.law = models::Law::make("kelvin", std::vector{1.0, 1.0, 1.0})};
  const std::string text(text_of(bytes));
  if (!is_taken<std::invalid_argument>([&] { law = bench::parse_law_file(text, "fuzz"); })) return;
  const std::string written = bench::to_toml(law);
  const std::string again = bench::to_toml(bench::parse_law_file(written, "written"));
  promise(again == written, "a law is written as it is read:\n" + written + "\n" + again);

  auto state = law.law.initial_state();
  if (law.law.is_spatial()) {
    const auto response = law.law.step(state, models::SpatialMotion{}, 1e-3);
    for (const double force : response.force) promise(std::isfinite(force), "a law gives finite forces");
  } else {
    const auto response = law.law.step(state, models::Motion{.penetration = 1e-3, .velocity = 0.1}, 1e-3);
    promise(std::isfinite(response.force), "a law gives finite forces");
  }
}

const Registered registered("law", fuzz_law);

}  // namespace
}  // namespace kerf::fuzz
