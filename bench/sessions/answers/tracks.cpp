#include "answers/tracks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>

#include "answers/analysis.h"
#include "protocol/trial_sequence.h"

namespace kerf::bench {
namespace {

std::vector<AdaptiveTrack> tracks_of(const Study& study, const std::vector<const Judgement*>& judgements) {
  std::vector<AdaptiveTrack> tracks;
  for (const Judgement* judgement : judgements) {
    auto track = std::find_if(tracks.begin(), tracks.end(), [&](const AdaptiveTrack& known) {
      return known.subject == judgement->subject && known.session == judgement->session &&
             known.number == judgement->track;
    });
    if (track == tracks.end()) {
      track = tracks.insert(
          tracks.end(),
          {.subject = judgement->subject, .session = judgement->session, .number = judgement->track});
    }
    track->levels.push_back(intensity_of(study, *judgement));
    track->right.push_back(judgement->is_right());
  }
  return tracks;
}

/// Gives the staircase its answers again; where the levels are not those of its rule it estimates nothing.
void follow_staircase(const psychophysics::StaircaseOptions& options, AdaptiveTrack& track) {
  psychophysics::Staircase staircase(options);
  for (std::size_t trial = 0; trial < track.levels.size(); ++trial) {
    if (staircase.finished()) {
      track.note = fmt::format("no mean of reversals: the rule ended after {} trials, and there are {}",
                               trial, track.levels.size());
      return;
    }
    const double expected = staircase.next();
    if (std::abs(track.levels[trial] - expected) > 1e-6 * expected) {
      track.note = fmt::format("no mean of reversals: trial {} is at {:.4g}, where the rule gives {:.4g}",
                               trial + 1, track.levels[trial], expected);
      return;
    }
    const std::size_t before = staircase.reversals().size();
    staircase.answer(track.right[trial]);
    if (staircase.reversals().size() > before) track.reversals.push_back(trial);
  }
  try {
    track.staircase = staircase.estimate();
  } catch (const std::invalid_argument&) {
    track.note = fmt::format(
        "no mean of reversals: there are {}, of which the first {} do not count, and it takes two",
        staircase.reversals().size(), options.dropped);
  }
}

void follow_quest(const Study& study, const AnalysisOptions& options, AdaptiveTrack& track) {
  const double guess = study.task ? psychophysics::chance_of(*study.task) : 0.5;
  psychophysics::QuestPlusOptions grid = quest_options_of(study.scale, guess);
  // Only what was shown matters to the posterior, and less of it is faster.
  grid.intensities = track.levels;
  std::sort(grid.intensities.begin(), grid.intensities.end());
  grid.intensities.erase(std::unique(grid.intensities.begin(), grid.intensities.end()),
                         grid.intensities.end());
  grid.trials = static_cast<int>(track.levels.size());
  grid.narrow = 0.0;  // it has ended
  try {
    psychophysics::QuestPlus quest(grid);
    for (std::size_t trial = 0; trial < track.levels.size(); ++trial)
      quest.answer(track.levels[trial], track.right[trial]);
    track.quest = quest.estimate(options.confidence);
  } catch (const std::invalid_argument& refused) {
    track.note = fmt::format("no posterior: {}", refused.what());
  }
}

}  // namespace

std::vector<AdaptiveTrack> adaptive_tracks(const Study& study,
                                           const std::vector<const Judgement*>& judgements,
                                           const AnalysisOptions& options) {
  if (!is_adaptive(study.design)) return {};
  std::vector<AdaptiveTrack> tracks = tracks_of(study, judgements);
  const std::vector<psychophysics::StaircaseOptions> rules = study.scale.staircases();
  for (AdaptiveTrack& track : tracks) {
    if (study.design == Design::staircase && track.number >= rules.size()) {
      track.note =
          fmt::format("no mean of reversals: the rule of staircase {} is not known", track.number + 1);
    } else if (study.design == Design::staircase) {
      follow_staircase(rules[track.number], track);
    } else {
      follow_quest(study, options, track);
    }
  }
  return tracks;
}

}  // namespace kerf::bench
