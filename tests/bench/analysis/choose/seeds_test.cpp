#include <atomic>
#include <string>

#include <gtest/gtest.h>

#include "choose/choose.h"
#include "fits/fit_series.h"
#include "fits/rendered_series.h"
#include "known_cuts.h"
#include "known_laws.h"
#include "recordings/contact_rows.h"

// What a choice makes of recordings whose law is known, over many of them.

namespace kerf::bench {
namespace {

using test::cut_of;

const std::atomic<bool> go_on{false};

ChooseOptions quick() {
  ChooseOptions options;
  options.candidates.max_segments = 4;
  options.richer_too = false;
  return options;
}

/// Whether the known law itself, as a loop renders it, stays within the JND of what it made.
bool can_be_rendered(const models::Law& law, const schema::Recording& recording) {
  const fitting::Jnd jnd;
  AxisSeries series = fit_series(recording, 0, contact_of(recording, 0));
  (void)mark_contact(series, jnd.threshold);
  const models::Law rendered =
      models::Law::make(law.model(), law.values(), with_rendering_aids(law.options(), series));
  AxisSeries left(series);
  left.force = RenderedSeries(series, 1000.0).force(rendered);
  for (std::size_t i = 0; i < left.force.size(); ++i) left.force[i] -= series.force[i];
  return fitting::rms_of(fitted_view(left)) <= jnd.at(fitting::rms_of(fitted_view(series)));
}

TEST(ChooseOverSeeds, ExplainsAKnownLawByNoneThatIsRicher) {
  const auto known = test::known_laws();
  int wrong = 0;
  int late = 0;
  std::string list;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const test::KnownLaw& law = known[seed % known.size()];
    const schema::Recording cut = cut_of(law.law, {.seed = seed});
    const LawChoice choice = choose_law(cut, quick(), go_on);
    // A branch for each direction switches late: as rendered not even the law that made the data serves.
    if (!choice.serves && !can_be_rendered(law.law, cut)) {
      ++late;
      continue;
    }
    if (choice.serves && choice.candidates.at(*choice.taken).law.parameters <= law.parameters) continue;
    ++wrong;
    list += std::string(law.name) + ": " + choice.why + '\n';
  }
  RecordProperty("wrong", wrong);
  EXPECT_LE(wrong, 3) << list;
  EXPECT_LE(late, 8) << "one of eight laws has two branches";
}

TEST(ChooseOverSeeds, ExplainsRelaxationByNoElasticLaw) {
  ChooseOptions options = quick();
  options.candidates.max_segments = 3;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const bool one_arm = seed % 2 == 0;
    const models::Law law =
        one_arm ? test::known_kelvin() : models::Law::make("maxwell", std::array{4.0, 6.0, 8.0, 0.05, 0.8});
    const LawChoice choice = choose_law(cut_of(law, {.seed = seed}), options, go_on);
    ASSERT_TRUE(choice.serves) << choice.why;
    EXPECT_TRUE(choice.candidates.at(*choice.taken).law.effects.contains(Effect::relaxation)) << choice.why;
  }
}

}  // namespace
}  // namespace kerf::bench
