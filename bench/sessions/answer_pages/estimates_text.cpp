#include "answer_pages/estimates_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/levels_json.h"
#include "files/json_number.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string value_text(double value) { return std::isnan(value) ? "-" : fmt::format("{:.3g}", value); }

std::string interval_text(psychophysics::Interval interval) {
  if (std::isnan(interval.lower)) return "no interval";
  return fmt::format("{:.3g} to {:.3g}", interval.lower, interval.upper);
}

const char* unit_of_values(const EstimateAnalysis& estimates) {
  if (!estimates.of_magnitudes) return "mean rating";
  return estimates.has_modulus ? "times the standard's number" : "times the mean of all samples";
}

/// "stiff over soft 2.1", "stiff less soft 1.3"
std::string pair_text(const EstimatedTissue& tissue, const EstimatedPair& pair, bool of_magnitudes) {
  return fmt::format("{} {} {}: {:.3g}", tissue.samples[pair.samples[1]].name,
                     of_magnitudes ? "over" : "less", tissue.samples[pair.samples[0]].name, pair.apart);
}

std::string tissue_prefix(const EstimatedTissue& tissue) {
  return tissue.tissue.empty() ? std::string() : tissue.tissue + ": ";
}

const char* family_name(const AnalysisOptions& options) {
  return options.correction == FamilyCorrection::holm ? "Holm" : "Benjamini-Hochberg";
}

std::string law_text(const PowerLaw& law, double confidence) {
  if (!law.mean)
    return fmt::format("exponent of {} {:.2f}", law.exponents.front().first, law.exponents.front().second);
  return fmt::format("exponent {:.2f} ({:.3g} % {:.2f} to {:.2f}, Student over {} subjects; of 1: {})",
                     law.mean->mean, 100.0 * confidence, law.mean->interval.lower, law.mean->interval.upper,
                     law.exponents.size(), p_text(law.p_of_one));
}

Json sample_as_json(const EstimatedSample& sample) {
  return {{"sample", sample.name},
          {"level", json_number(sample.level)},
          {"answers", sample.answers},
          {"value", json_number(sample.value)},
          {"ci95", pair_of(sample.interval)},
          {"intensity", json_number(sample.intensity)}};
}

Json tissue_as_json(const EstimatedTissue& tissue, bool of_magnitudes) {
  Json samples = Json::array();
  for (const EstimatedSample& sample : tissue.samples) samples.push_back(sample_as_json(sample));
  Json pairs = Json::array();
  for (const EstimatedPair& pair : tissue.pairs) {
    pairs.push_back({{"first", tissue.samples[pair.samples[0]].name},
                     {"second", tissue.samples[pair.samples[1]].name},
                     {of_magnitudes ? "ratio" : "difference", json_number(pair.apart)},
                     {"ci95", pair_of(pair.interval)},
                     {"p_value", json_number(pair.p)},
                     {"p_adjusted", json_number(pair.p_adjusted)}});
  }
  Json friedman = nullptr;
  if (tissue.friedman) {
    friedman = {{"chi_squared", json_number(tissue.friedman->statistic)},
                {"freedom", tissue.friedman->degrees_of_freedom},
                {"p_value", json_number(tissue.friedman->p)},
                {"mean_ranks", json_numbers(tissue.friedman->mean_ranks)},
                {"kendalls_w", json_number(tissue.friedman->agreement)}};
  }
  return {{"tissue", tissue.tissue},       {"subjects", tissue.subjects}, {"left_out", tissue.left_out},
          {"samples", std::move(samples)}, {"pairs", std::move(pairs)},   {"friedman", std::move(friedman)}};
}

Json law_as_json(const PowerLaw& law) {
  Json exponents = Json::array();
  for (const auto& [subject, exponent] : law.exponents)
    exponents.push_back({{"subject", subject}, {"exponent", json_number(exponent)}});
  Json described{{"intensity", law.of_levels ? "1 + level" : "rms of the force felt"},
                 {"by_subject", std::move(exponents)},
                 {"mean", nullptr}};
  if (law.mean) {
    described["mean"] = json_number(law.mean->mean);
    described["ci95"] = pair_of(law.mean->interval);
    described["p_of_one"] = json_number(law.p_of_one);
  }
  return described;
}

void add_tissue_rows(const EstimatedTissue& tissue, const Analysis& analysis, std::string& html) {
  const bool of_magnitudes = analysis.estimates->of_magnitudes;
  if (!tissue.tissue.empty()) html += fmt::format("<p>{}</p>\n", escaped(tissue.tissue));
  const std::string interval = fmt::format("{:.3g} %", 100.0 * analysis.options.confidence);
  std::vector<std::vector<std::string>> samples{
      {"sample", "answers", unit_of_values(*analysis.estimates), interval,
       analysis.estimates->law && analysis.estimates->law->of_levels ? "intensity" : "rms felt [N]"}};
  for (const EstimatedSample& sample : tissue.samples)
    samples.push_back({sample.name, fmt::format("{}", sample.answers), value_text(sample.value),
                       interval_text(sample.interval), value_text(sample.intensity)});
  html += html_table(samples);
  if (tissue.pairs.empty()) return;
  std::vector<std::vector<std::string>> pairs{{of_magnitudes ? "ratio of" : "difference of", "", interval,
                                               "p", fmt::format("p ({})", family_name(analysis.options))}};
  for (const EstimatedPair& pair : tissue.pairs)
    pairs.push_back({fmt::format("{} {} {}", tissue.samples[pair.samples[1]].name,
                                 of_magnitudes ? "over" : "less", tissue.samples[pair.samples[0]].name),
                     value_text(pair.apart), interval_text(pair.interval), p_text(pair.p),
                     p_text(pair.p_adjusted)});
  html += html_table(pairs);
  if (tissue.friedman)
    html += fmt::format("<p class=\"soft\">Friedman: chi-squared {:.2f} on {}, {}; Kendall's W {:.2f}.</p>\n",
                        tissue.friedman->statistic, tissue.friedman->degrees_of_freedom,
                        escaped(p_text(tissue.friedman->p)), tissue.friedman->agreement);
}

void add_apart(const EstimatedTissue& tissue, Analysis& analysis) {
  const EstimateAnalysis& estimates = *analysis.estimates;
  for (const EstimatedPair& pair : tissue.pairs) {
    const std::string text =
        fmt::format("{}{} ({:.3g} % {}), {} after {}", tissue_prefix(tissue),
                    pair_text(tissue, pair, estimates.of_magnitudes), 100.0 * analysis.options.confidence,
                    interval_text(pair.interval), p_text(pair.p_adjusted), family_name(analysis.options));
    if (pair.p_adjusted <= analysis.options.level) {
      analysis.shows.push_back(as_sentence(text));
    } else {
      analysis.shows_not.push_back(as_sentence("that two are told apart: " + text));
    }
  }
}

}  // namespace

Json estimates_as_json(const EstimateAnalysis& estimates) {
  Json tissues = Json::array();
  for (const EstimatedTissue& tissue : estimates.tissues)
    tissues.push_back(tissue_as_json(tissue, estimates.of_magnitudes));
  return {{"of", estimates.of_magnitudes ? "magnitudes" : "ratings"},
          {"value", unit_of_values(estimates)},
          {"points", estimates.points > 0 ? Json(estimates.points) : Json(nullptr)},
          {"tissues", std::move(tissues)},
          {"power_law", estimates.law ? law_as_json(*estimates.law) : Json(nullptr)}};
}

std::vector<std::string> estimate_lines(const Analysis& analysis) {
  const EstimateAnalysis& estimates = *analysis.estimates;
  std::vector<std::string> lines{fmt::format("{}: {}", estimates.main_test, p_text(analysis.p_value))};
  for (const EstimatedTissue& tissue : estimates.tissues) {
    for (const EstimatedSample& sample : tissue.samples)
      lines.push_back(fmt::format("  {}{}: {} {} ({:.3g} % {}; {})", tissue_prefix(tissue), sample.name,
                                  value_text(sample.value), unit_of_values(estimates),
                                  100.0 * analysis.options.confidence, interval_text(sample.interval),
                                  plural(sample.answers, "answer")));
  }
  if (estimates.law)
    lines.push_back("Stevens' power law: " + law_text(*estimates.law, analysis.options.confidence));
  return lines;
}

std::string estimates_section(const Analysis& analysis) {
  const EstimateAnalysis& estimates = *analysis.estimates;
  std::string html = fmt::format(
      "<h2>{}</h2>\n<p class=\"soft\">Main test: {}. Each subject counts once; intervals are "
      "Student's over subjects.</p>\n",
      estimates.of_magnitudes ? "Magnitudes" : "Ratings", escaped(estimates.main_test));
  for (const EstimatedTissue& tissue : estimates.tissues) add_tissue_rows(tissue, analysis, html);
  if (!estimates.law) return html;
  std::vector<std::vector<std::string>> rows{{"subject", "exponent"}};
  for (const auto& [subject, exponent] : estimates.law->exponents)
    rows.push_back({subject, fmt::format("{:.2f}", exponent)});
  return html +
         fmt::format("<p>Stevens' power law: {}.</p>\n",
                     escaped(law_text(*estimates.law, analysis.options.confidence))) +
         html_table(rows);
}

Json questionnaire_as_json(const Analysis& analysis) {
  Json scores = Json::array();
  for (const QuestionnaireScore& score : analysis.questionnaire)
    scores.push_back(
        {{"tissue", score.tissue},
         {"item", score.item},
         {"subjects", score.subjects},
         {"mean", json_number(score.mean)},
         {"ci95", score.over_subjects ? pair_of(score.over_subjects->interval) : Json(nullptr)}});
  return scores;
}

std::vector<std::string> questionnaire_lines(const Analysis& analysis) {
  std::vector<std::string> lines;
  for (const QuestionnaireScore& score : analysis.questionnaire) {
    lines.push_back(fmt::format("questionnaire, {}{}{}: {:.1f} of 100 ({})", score.tissue,
                                score.tissue.empty() ? "" : ": ", score.item, score.mean,
                                plural(score.subjects, "subject")));
    if (score.over_subjects)
      lines.back().replace(
          lines.back().size() - 1, 1,
          fmt::format(", {:.3g} % {:.1f} to {:.1f})", 100.0 * analysis.options.confidence,
                      score.over_subjects->interval.lower, score.over_subjects->interval.upper));
  }
  return lines;
}

std::string questionnaire_section(const Analysis& analysis) {
  if (analysis.questionnaire.empty()) return {};
  std::vector<std::vector<std::string>> rows{{"tissue", "item", "subjects", "mean of 100",
                                              fmt::format("{:.3g} %", 100.0 * analysis.options.confidence)}};
  for (const QuestionnaireScore& score : analysis.questionnaire)
    rows.push_back({score.tissue, score.item, fmt::format("{}", score.subjects),
                    fmt::format("{:.1f}", score.mean),
                    score.over_subjects ? interval_text(score.over_subjects->interval) : std::string("-")});
  return "<h2>Questionnaire</h2>\n" + html_table(rows);
}

void add_estimate_findings(Analysis& analysis) {
  const EstimateAnalysis& estimates = *analysis.estimates;
  const bool of_levels = estimates.law && estimates.law->of_levels;
  for (const EstimatedTissue& tissue : estimates.tissues) {
    if (tissue.friedman) {
      const std::string found =
          fmt::format("{}chi-squared {:.2f} on {}, {}", tissue_prefix(tissue), tissue.friedman->statistic,
                      tissue.friedman->degrees_of_freedom, p_text(tissue.friedman->p));
      if (tissue.friedman->p <= analysis.options.level) {
        analysis.shows.push_back(
            as_sentence("the samples are rated differently by people (Friedman): " + found));
      } else {
        analysis.shows_not.push_back(
            as_sentence("that people rate the samples differently (Friedman): " + found));
      }
    }
    if (!of_levels) add_apart(tissue, analysis);
    if (tissue.left_out > 0)
      analysis.warnings.push_back(as_sentence(
          fmt::format("{}{} did not answer about every sample, and {} left out of it", tissue_prefix(tissue),
                      plural(tissue.left_out, "subject"), tissue.left_out == 1 ? "is" : "are")));
  }
  if (estimates.law && estimates.law->mean) {
    const PowerLaw& law = *estimates.law;
    analysis.shows.push_back(
        as_sentence("of Stevens' power law the " + law_text(law, analysis.options.confidence)));
    if (law.p_of_one > analysis.options.level)
      analysis.shows_not.push_back(as_sentence("that magnitudes do not grow in proportion: 1 is within it"));
    if (!law.of_levels)
      analysis.warnings.push_back(
          as_sentence("the exponent is over the forces that each hand got, which follow its motion"));
  }
  if (analysis.subjects.size() < 2) analysis.shows_not.push_back("Anything of people: it is one subject.");
  if (estimates.of_magnitudes && !estimates.has_modulus)
    analysis.shows_not.push_back(as_sentence(
        "how strong anything is beside other studies: everybody chose the size of their numbers"));
}

}  // namespace kerf::bench
