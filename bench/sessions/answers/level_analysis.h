#pragma once

#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/mixed_fit.h>
#include <kerf/psychophysics/psychometric_fit.h>

#include "protocol/judgement.h"

// Answers at levels: psychometric functions.

namespace kerf::bench {

struct AnalysisOptions;

/// The psychometric function of a subject, or of all.
struct LevelFit {
  std::string name;
  std::vector<psychophysics::Level> points;  ///< one a level
  std::optional<psychophysics::PsychometricFit> fit;
  std::optional<psychophysics::Bootstrap> bootstrap;
  std::optional<psychophysics::Threshold> equality;  ///< PSE: of levels on both sides
  std::optional<psychophysics::Threshold> jnd;       ///< fraction of the standard
  /// After an adaptive design, of one subject: the JND is the median of a posterior, and its interval
  /// credible. Otherwise it is that of the fit.
  bool by_posterior = false;
  std::optional<bool> jnd_within;  ///< the margins, where there are some
  std::vector<std::string> notes;  ///< why something is missing or open
};

/// A shape of the curve over all answers, against the others.
struct ShapeFit {
  psychophysics::Shape shape = psychophysics::Shape::weibull;
  int parameters = 0;
  double log_likelihood = 0.0;
  double deviance = 0.0;
  double aic = 0.0;
  double jnd = 0.0;
};

/// What holds for the people that subjects stand for: a mixed model, whose subjects have curves of their own.
struct PeopleFit {
  psychophysics::MixedFit fit;
  psychophysics::OfPeople jnd;                      ///< fraction of the standard
  std::optional<psychophysics::OfPeople> equality;  ///< PSE: of levels on both sides
  std::optional<bool> jnd_within;                   ///< the margins, where there are some
};

struct LevelAnalysis {
  bool two_sided = false;
  psychophysics::Axis axis = psychophysics::Axis::logarithmic;
  psychophysics::Shape shape = psychophysics::Shape::weibull;  ///< the main one
  double guess = 0.5;
  LevelFit pooled;
  std::vector<LevelFit> by_subject;
  std::optional<PeopleFit>
      people;  ///< of constant levels, from three subjects on; otherwise `notes` say why not
  std::optional<psychophysics::AcrossSubjects> across;           ///< of the JNDs
  std::optional<psychophysics::AcrossSubjects> across_equality;  ///< of the PSEs
  std::vector<ShapeFit> shapes;                                  ///< all that the axis allows, the main first
  std::vector<std::string> notes;
};

/// The pooled fit and that of people alone where `thorough` is false.
[[nodiscard]] LevelAnalysis analyse_levels(const Study& study,
                                           const std::vector<const Judgement*>& judgements,
                                           const AnalysisOptions& options, bool thorough = true);

/// Distance from the standard as the curve sees it: on one side its size.
[[nodiscard]] double intensity_of(const Study& study, const Judgement& judgement) noexcept;

}  // namespace kerf::bench
