#include "answer_pages/analysis_words.h"

#include <cctype>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "answer_pages/estimates_text.h"
#include "answer_pages/experiment_words.h"
#include "answer_pages/explored_words.h"
#include "answer_pages/felt_words.h"

namespace kerf::bench {
namespace {

std::string power_text(const AnswerGroup& group) {
  std::string text;
  for (const TestPower& power : group.power) {
    text += fmt::format("{}{:.2f} for {:.3g} %", text.empty() ? "power " : ", ", power.power,
                        100.0 * power.truth);
    if (power.trials_needed > 0) text += fmt::format(" (0.80 takes {} trials)", power.trials_needed);
  }
  return text;
}

std::string group_line(const AnswerGroup& group, const Analysis& analysis, bool in_family) {
  std::string line = fmt::format("{}: {}, {}", group.name.empty() ? std::string("(no name)") : group.name,
                                 count_text(group, analysis.options.confidence), p_text(group.p_value));
  if (std::isnan(group.p_value)) return fmt::format("{} ({})", line.substr(0, line.size() - 6), group.note);
  if (in_family && !std::isnan(group.p_adjusted)) {
    line += fmt::format(" ({} {})",
                        analysis.options.correction == FamilyCorrection::holm ? "Holm" : "Benjamini-Hochberg",
                        p_text(group.p_adjusted).substr(2));
  } else if (!std::isnan(group.p_value)) {
    line +=
        fmt::format(" ({}, {}, chance {:.3g} %)", group.one_sided ? "one-sided" : "two-sided",
                    group.tests_subjects ? "signs of the subjects flipped" : "exact", 100.0 * group.chance);
  }
  if (group.d_prime)
    line += fmt::format(", d' {} ({})", d_prime_text(group.d_prime->value),
                        d_prime_text(group.d_prime->interval));
  return line;
}

std::string margin_text(const AnswerGroup& group, const std::string& margin) {
  if (!group.equivalence) return "no margin was set";
  const GroupEquivalence& found = *group.equivalence;
  std::string text = fmt::format("{} is {} ({}{})", margin, found.is_shown ? "kept" : "not shown to be kept",
                                 p_text(found.p), found.subjects_differ ? ", but the subjects differ" : "");
  if (group.subjects > 1)
    text += fmt::format("; for {} of {} subjects alone", found.subjects_shown, group.subjects);
  return text;
}

/// Empty where nothing is excluded of the group and nothing was asked.
std::string equivalence_line(const AnswerGroup& group, const AnalysisOptions& options) {
  const double level = 100.0 * options.level;
  const char* of = group.subjects > 2 ? "mean " : "";
  if (group.d_prime) {
    const auto bound =
        margin_text(group, fmt::format("the bound of {:.3g}", options.d_prime_bound.value_or(0.0)));
    return std::isfinite(group.excluded_d_prime)
               ? fmt::format("a {}d' above {} is excluded at {:.3g} %; {}", of,
                             d_prime_text(group.excluded_d_prime), level, bound)
               : fmt::format("no d' is excluded at {:.3g} %; {}", level, bound);
  }
  if (group.counted == "right") return "";
  return fmt::format(
      "{}preferences beyond {} either way are excluded at {:.3g} %; {}", of,
      percent_text(group.chance + group.excluded_margin), level,
      margin_text(group, fmt::format("a margin of +- {:.3g} %", 100.0 * options.margin.value_or(0.0))));
}

std::string level_line(const LevelFit& fit, const LevelAnalysis& levels, double confidence) {
  std::string line = fmt::format("{}: ", fit.name);
  if (fit.jnd) line += threshold_text("JND", *fit.jnd, criterion_text(levels, *fit.jnd).c_str(), confidence);
  if (fit.equality)
    line += fmt::format("{}{}", fit.jnd ? "; " : "",
                        threshold_text("PSE", *fit.equality, "from the standard", confidence));
  if (fit.fit) line += fmt::format("{}slope {:.3g}", fit.jnd || fit.equality ? "; " : "", fit.fit->slope);
  for (const std::string& note : fit.notes)
    line += fmt::format("{}{}", line.ends_with(": ") ? "" : "; ", note);
  return line;
}

void add_level_lines(const Analysis& analysis, std::vector<std::string>& lines) {
  const LevelAnalysis& levels = *analysis.levels;
  const double confidence = analysis.options.confidence;
  lines.push_back(level_line(levels.pooled, levels, confidence));
  for (const LevelFit& subject : levels.by_subject)
    lines.push_back("  " + level_line(subject, levels, confidence));
  if (levels.people) {
    const PeopleFit& people = *levels.people;
    std::string line =
        fmt::format("JND of people, mixed model: {} ({:.3g} % {}; between people a factor of {:.2f})",
                    percent_text(people.jnd.mean), 100.0 * confidence,
                    percent_text(people.jnd.interval(confidence)), std::exp(people.jnd.deviation));
    if (people.equality)
      line += fmt::format("; PSE {} ({:.3g} % {}; between people {})", percent_text(people.equality->mean),
                          100.0 * confidence, percent_text(people.equality->interval(confidence)),
                          percent_text(people.equality->deviation));
    lines.push_back(std::move(line));
  }
  if (levels.across) {
    lines.push_back(fmt::format("mean JND of the subjects: {} ({:.3g} % {}, Student)",
                                percent_text(levels.across->mean), 100.0 * confidence,
                                percent_text(levels.across->interval)));
  }
  for (const AdaptiveTrack& track : analysis.tracks) {
    const std::string who = fmt::format("  {}, session {}: ", track.subject, track.session);
    if (track.staircase) {
      lines.push_back(fmt::format("{}mean of {} reversals {} at {} right", who, track.staircase->reversals,
                                  percent_text(track.staircase->threshold),
                                  percent_text(track.staircase->probability)));
    } else if (track.quest) {
      lines.push_back(fmt::format("{}threshold of the curve by QUEST+ {} ({:.3g} % credible {})", who,
                                  percent_text(track.quest->threshold), 100.0 * confidence,
                                  percent_text(track.quest->interval)));
    } else {
      lines.push_back(who + track.note);
    }
  }
}

void add_ranking_lines(const Analysis& analysis, std::vector<std::string>& lines) {
  for (const TissueRanking& ranking : analysis.rankings) {
    const std::string tissue = ranking.tissue.empty() ? std::string("ranking") : ranking.tissue;
    if (!ranking.bradley_terry) {
      lines.push_back(fmt::format("{}: no ranking: {}", tissue, ranking.note));
      continue;
    }
    std::string line = fmt::format("{}: Bradley-Terry worth", tissue);
    for (std::size_t i = 0; i < ranking.samples.size(); ++i) {
      line += fmt::format("{} {} {:+.2f} +- {:.2f}", i == 0 ? "" : ",", analysis.samples[ranking.samples[i]],
                          ranking.bradley_terry->worth[i], ranking.error_of(i));
    }
    lines.push_back(fmt::format("{}; all equal: {}{}", line, p_text(ranking.p_value()),
                                ranking.tests_subjects ? " (flipped by subjects)" : ""));
  }
}

}  // namespace

std::string p_text(double p) {
  if (std::isnan(p)) return "no p";
  if (p < 1e-4) return "p < 0.0001";
  return p >= 0.1    ? fmt::format("p = {:.2f}", p)
         : p >= 1e-3 ? fmt::format("p = {:.3f}", p)
                     : fmt::format("p = {:.4f}", p);
}

std::string percent_text(double share) { return fmt::format("{:.1f} %", 100.0 * share); }

std::string percent_text(psychophysics::Interval interval) {
  const bool has_lower = std::isfinite(interval.lower);
  if (!std::isfinite(interval.upper))
    return has_lower ? fmt::format("above {:.1f} %", 100.0 * interval.lower) : std::string("no limits");
  if (!has_lower) return fmt::format("below {:.1f} %", 100.0 * interval.upper);
  return fmt::format("{:.1f} to {:.1f} %", 100.0 * interval.lower, 100.0 * interval.upper);
}

std::string d_prime_text(double value) {
  return std::isfinite(value) ? fmt::format("{:.2f}", value == 0.0 ? 0.0 : value) : std::string("no limit");
}

std::string d_prime_text(psychophysics::Interval interval) {
  const bool has_lower = std::isfinite(interval.lower);
  if (!std::isfinite(interval.upper))
    return has_lower ? fmt::format("above {:.2f}", interval.lower) : std::string("no limits");
  if (!has_lower) return fmt::format("below {:.2f}", interval.upper);
  return fmt::format("{:.2f} to {:.2f}", interval.lower, interval.upper);
}

std::string count_text(const AnswerGroup& group, double confidence) {
  const double share = static_cast<double>(group.count.successes) / group.count.trials;
  return fmt::format("{} of {} {} ({}, {:.3g} % {})", group.count.successes, group.count.trials,
                     group.counted, percent_text(share), 100.0 * confidence, percent_text(group.interval));
}

std::string threshold_text(const char* name, const psychophysics::Threshold& threshold, const char* of,
                           double confidence) {
  return fmt::format("{} {} {} ({:.3g} % {})", name, percent_text(threshold.value), of, 100.0 * confidence,
                     percent_text(threshold.interval));
}

std::string criterion_text(const LevelAnalysis& levels, const psychophysics::Threshold& threshold) {
  if (levels.two_sided) return "of the standard, half of 25 to 75 %";
  return fmt::format("of the standard at {:.3g} % right", 100.0 * threshold.criterion);
}

const char* name_of(psychophysics::Shape shape) noexcept {
  switch (shape) {
    case psychophysics::Shape::weibull:
      return "weibull";
    case psychophysics::Shape::logistic:
      return "logistic";
    case psychophysics::Shape::gaussian:
      return "gaussian";
  }
  return "unknown";
}

std::string plural(std::size_t count, const char* of) {
  return fmt::format("{} {}{}", count, of, count == 1 ? "" : "s");
}

std::string as_sentence(std::string text) {
  const std::string_view first_word = std::string_view(text).substr(0, text.find(' '));
  if (!text.empty() && first_word.find_first_of("/.") == std::string_view::npos)
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  if (!text.ends_with('.') && !text.ends_with('?')) text += '.';
  return text;
}

std::string times_text(const ResponseTimes& times) {
  std::string text = fmt::format("answered in {:.2f} s (median; half of them in {:.2f} to {:.2f} s)",
                                 times.median_s, times.lower_quartile_s, times.upper_quartile_s);
  if (std::isfinite(times.right_is_faster)) {
    text += fmt::format(
        "; right ones in {:.2f} s, wrong ones in {:.2f} s, and a right one is the faster in {} ({})",
        times.median_right_s, times.median_wrong_s, percent_text(times.right_is_faster),
        p_text(times.p_value));
  }
  return text;
}

std::string catches_text(const std::vector<SubjectCatches>& catches) {
  std::string text;
  for (const SubjectCatches& each : catches)
    text += fmt::format("{}{} {} of {}{}", text.empty() ? "" : ", ", each.subject, each.tally.right,
                        each.tally.trials, text.empty() ? " right" : "");
  return "catch trials, which are in no test: " + text;
}

std::vector<std::string> summary_lines(const Analysis& analysis) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "{}: {}, {} of {}{}", analysis.name, name_of(analysis.design), plural(analysis.trials, "trial"),
      plural(analysis.subjects.size(), "subject"),
      analysis.practice > 0 ? fmt::format(" ({} of practice left out)", analysis.practice) : std::string()));
  if (analysis.all) {
    lines.push_back(group_line(*analysis.all, analysis, false));
    std::string excluded = equivalence_line(*analysis.all, analysis.options);
    if (!excluded.empty()) lines.push_back(std::move(excluded));
    if (!std::isnan(analysis.p_value) && !analysis.all->power.empty())
      lines.push_back(power_text(*analysis.all));
  }
  if (analysis.by_tissue.size() > 1) {
    for (const AnswerGroup& group : analysis.by_tissue)
      lines.push_back("  " + group_line(group, analysis, true));
  }
  for (const AnswerGroup& group : analysis.by_pair) lines.push_back("  " + group_line(group, analysis, true));
  if (analysis.by_subject.size() > 1 && !analysis.levels) {
    for (const AnswerGroup& group : analysis.by_subject)
      lines.push_back(fmt::format("  subject {}", group_line(group, analysis, true)));
  }
  add_ranking_lines(analysis, lines);
  if (analysis.estimates) {
    for (std::string& line : estimate_lines(analysis)) lines.push_back(std::move(line));
  }
  if (analysis.levels) add_level_lines(analysis, lines);
  if (!analysis.catches.empty()) lines.push_back(catches_text(analysis.catches));
  for (std::string& line : questionnaire_lines(analysis)) lines.push_back(std::move(line));
  if (analysis.times.trials > 0) lines.push_back(times_text(analysis.times));
  for (std::string& line : felt_lines(analysis.felt, analysis.samples, analysis.options.confidence))
    lines.push_back(std::move(line));
  for (std::string& line : explored_lines(analysis.explored, analysis.samples, analysis.options.confidence))
    lines.push_back(std::move(line));
  if (analysis.experiment) {
    for (std::string& line : experiment_lines(*analysis.experiment)) lines.push_back(std::move(line));
  }
  for (const auto& [title, sentences] : {std::pair{"shown", &analysis.shows},
                                         {"not shown", &analysis.shows_not},
                                         {"mind", &analysis.warnings}}) {
    for (const std::string& sentence : *sentences) lines.push_back(fmt::format("{}: {}", title, sentence));
  }
  return lines;
}

}  // namespace kerf::bench
