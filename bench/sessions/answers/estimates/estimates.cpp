#include "answers/estimates/estimates.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include <kerf/psychophysics/comparisons.h>
#include <kerf/psychophysics/sign_flips.h>

#include "answers/analysis.h"

namespace kerf::bench {
namespace {

using Answers = std::vector<const Judgement*>;

constexpr double no_estimate = std::numeric_limits<double>::quiet_NaN();
constexpr double least_span = 1.5;  ///< of intensities, for an exponent

/// Sums of what one subject said of one sample.
struct Said {
  double values = 0.0;  ///< of magnitudes their logarithms
  double log_intensities = 0.0;
  std::size_t answers = 0;
  std::size_t known = 0;  ///< intensities

  [[nodiscard]] double mean() const { return values / static_cast<double>(answers); }
  [[nodiscard]] double log_intensity() const {
    return known == 0 ? no_estimate : log_intensities / static_cast<double>(known);
  }
};

/// Means of one subject, sample by sample.
struct SubjectMeans {
  std::string subject;
  std::vector<double> values;
  std::vector<double> log_intensities;
};

void require_number(const Study& study, const Judgement& judgement) {
  const bool is_magnitude = study.design == Design::magnitude;
  const double upper = study.numbers.points > 0 ? static_cast<double>(study.numbers.points) : largest_rating;
  const double lower = study.numbers.points > 0 ? 1.0 : 0.0;
  const bool is_one = is_magnitude ? judgement.estimate > 0.0 && std::isfinite(judgement.estimate)
                                   : judgement.estimate >= lower && judgement.estimate <= upper;
  if (is_one) return;
  throw std::invalid_argument(fmt::format(
      "{}: subject {} answered {:g}, expected {}", study.name, judgement.subject, judgement.estimate,
      is_magnitude ? std::string("a number above 0") : fmt::format("one from {:g} to {:g}", lower, upper)));
}

std::vector<double> adjusted_of(const std::vector<double>& p, const AnalysisOptions& options) {
  return options.correction == FamilyCorrection::holm ? psychophysics::holm(p)
                                                      : psychophysics::benjamini_hochberg(p);
}

class Estimating {
 public:
  Estimating(const Study& study, const Answers& judgements, const AnalysisOptions& options)
      : study_(study), judgements_(judgements), options_(options) {
    result_.of_magnitudes = study.design == Design::magnitude;
    result_.has_modulus = study.numbers.modulus > 0.0;
    result_.points = study.numbers.points;
  }

  EstimateAnalysis analysed() {
    std::vector<std::string> tissues;
    for (const Judgement* judgement : judgements_) {
      require_number(study_, *judgement);
      if (std::ranges::find(tissues, judgement->tissue) == tissues.end())
        tissues.push_back(judgement->tissue);
    }
    for (const std::string& tissue : tissues) add_tissue(tissue);
    adjust_pairs();
    add_law();
    name_test();
    return std::move(result_);
  }

 private:
  using Key = std::pair<std::size_t, double>;  ///< sample and level, 0 for none

  [[nodiscard]] double value_of(const Judgement& judgement) const {
    if (!result_.of_magnitudes) return judgement.estimate;
    return std::log(judgement.estimate / (result_.has_modulus ? study_.numbers.modulus : 1.0));
  }

  void add_tissue(const std::string& name) {
    EstimatedTissue tissue{.tissue = name};
    std::map<Key, std::size_t> places;
    std::vector<std::string> subjects;
    for (const Judgement* judgement : judgements_) {
      if (judgement->tissue != name) continue;
      const bool has_level = !std::isnan(judgement->level);
      places.emplace(Key{judgement->pair[1], has_level ? judgement->level : 0.0}, 0);
      if (std::ranges::find(subjects, judgement->subject) == subjects.end())
        subjects.push_back(judgement->subject);
    }
    std::map<std::string, std::vector<Said>> said;
    for (auto& [key, place] : places) {
      place = tissue.samples.size();
      tissue.samples.push_back({.sample = key.first});
    }
    for (const Judgement* judgement : judgements_) {
      if (judgement->tissue != name) continue;
      const double level = std::isnan(judgement->level) ? 0.0 : judgement->level;
      EstimatedSample& sample = tissue.samples[places.at({judgement->pair[1], level})];
      sample.level = judgement->level;
      ++sample.answers;
      auto& of_subject = said[judgement->subject];
      of_subject.resize(places.size());
      Said& one = of_subject[places.at({judgement->pair[1], level})];
      one.values += value_of(*judgement);
      ++one.answers;
      if (judgement->intensity > 0.0) {
        one.log_intensities += std::log(judgement->intensity);
        ++one.known;
      }
    }
    for (EstimatedSample& sample : tissue.samples) {
      sample.name = study_.samples.at(sample.sample);
      if (!std::isnan(sample.level)) sample.name += fmt::format(" times {:.4g}", 1.0 + sample.level);
    }
    std::vector<SubjectMeans> means;
    for (const std::string& subject : subjects) {
      const std::vector<Said>& own = said.at(subject);
      if (std::ranges::any_of(own, [](const Said& one) { return one.answers == 0; })) {
        ++tissue.left_out;
        continue;
      }
      SubjectMeans& one =
          means.emplace_back(SubjectMeans{.subject = subject, .values = {}, .log_intensities = {}});
      for (const Said& each : own) {
        one.values.push_back(each.mean());
        one.log_intensities.push_back(each.log_intensity());
      }
    }
    tissue.subjects = means.size();
    if (!means.empty()) {
      add_samples(tissue, means);
      add_pairs(tissue, means);
      add_friedman(tissue, means);
    }
    means_.insert(means_.end(), means.begin(), means.end());
    result_.tissues.push_back(std::move(tissue));
  }

  /// Numbers that everybody chose freely differ by a factor that says nothing: it is taken out of each.
  [[nodiscard]] double modulus_of(const SubjectMeans& subject) const {
    if (!result_.of_magnitudes || result_.has_modulus) return 0.0;
    double sum = 0.0;
    for (const double value : subject.values) sum += value;
    return sum / static_cast<double>(subject.values.size());
  }

  [[nodiscard]] double as_told(double value) const { return result_.of_magnitudes ? std::exp(value) : value; }

  void add_samples(EstimatedTissue& tissue, const std::vector<SubjectMeans>& means) const {
    for (std::size_t at = 0; at < tissue.samples.size(); ++at) {
      EstimatedSample& sample = tissue.samples[at];
      std::vector<double> values;
      double log_intensity = 0.0;
      for (const SubjectMeans& subject : means) {
        values.push_back(subject.values[at] - modulus_of(subject));
        log_intensity += subject.log_intensities[at] / static_cast<double>(means.size());
      }
      sample.intensity = std::exp(log_intensity);
      double sum = 0.0;
      for (const double value : values) sum += value;
      sample.value = as_told(sum / static_cast<double>(values.size()));
      if (values.size() < 2) continue;
      const auto interval = psychophysics::subjects_mean(values, options_.confidence).interval;
      sample.interval = {.lower = as_told(interval.lower), .upper = as_told(interval.upper)};
    }
  }

  void add_pairs(EstimatedTissue& tissue, const std::vector<SubjectMeans>& means) const {
    if (means.size() < 2) return;
    for (std::size_t i = 0; i < tissue.samples.size(); ++i) {
      for (std::size_t j = i + 1; j < tissue.samples.size(); ++j) {
        std::vector<double> apart;
        for (const SubjectMeans& subject : means) apart.push_back(subject.values[j] - subject.values[i]);
        const auto mean = psychophysics::subjects_mean(apart, options_.confidence);
        tissue.pairs.push_back(
            {.samples = {i, j},
             .apart = as_told(mean.mean),
             .interval = {.lower = as_told(mean.interval.lower), .upper = as_told(mean.interval.upper)},
             .p = result_.of_magnitudes
                      ? mean.p_of(0.0)
                      : psychophysics::flip_signs(apart, {.seed = options_.seed}).p_two_sided});
      }
    }
  }

  void add_friedman(EstimatedTissue& tissue, const std::vector<SubjectMeans>& means) const {
    if (result_.of_magnitudes || means.size() < 2 || tissue.samples.size() < 3) return;
    std::vector<std::vector<double>> rows;
    for (const SubjectMeans& subject : means) rows.push_back(subject.values);
    tissue.friedman = psychophysics::friedman_test(rows);
  }

  /// All pairs of the study are one family.
  void adjust_pairs() {
    std::vector<double> p;
    for (const EstimatedTissue& tissue : result_.tissues) {
      for (const EstimatedPair& pair : tissue.pairs) p.push_back(pair.p);
    }
    const std::vector<double> adjusted = adjusted_of(p, options_);
    std::size_t next = 0;
    for (EstimatedTissue& tissue : result_.tissues) {
      for (EstimatedPair& pair : tissue.pairs) pair.p_adjusted = adjusted[next++];
    }
  }

  /// The samples of one tissue lie on one line; of several, each with its own, the mean of their slopes.
  void add_law() {
    if (!result_.of_magnitudes) return;
    PowerLaw law{.of_levels = !study_.judgements.empty() && !std::isnan(judgements_.front()->level)};
    std::map<std::string, std::pair<double, int>> slopes;
    std::vector<std::string> order;
    for (const SubjectMeans& subject : means_) {
      const auto [least, most] = std::ranges::minmax(subject.log_intensities);
      const bool is_known =
          std::ranges::none_of(subject.log_intensities, [](double it) { return std::isnan(it); });
      if (!is_known || subject.values.size() < 2 || most - least < std::log(least_span)) continue;
      if (!slopes.contains(subject.subject)) order.push_back(subject.subject);
      auto& [sum, count] = slopes[subject.subject];
      sum += psychophysics::slope_of_line(subject.log_intensities, subject.values);
      ++count;
    }
    if (order.empty()) return;
    std::vector<double> values;
    for (const std::string& subject : order) {
      const auto& [sum, count] = slopes.at(subject);
      values.push_back(sum / count);
      law.exponents.emplace_back(subject, values.back());
    }
    if (values.size() >= 2) {
      law.mean = psychophysics::subjects_mean(values, options_.confidence);
      law.p_of_one = law.mean->p_of(1.0);
    }
    result_.law = std::move(law);
  }

  void name_test() {
    if (result_.of_magnitudes && !std::isnan(judgements_.front()->level)) return name_law_test();
    std::vector<double> p;
    for (const EstimatedTissue& tissue : result_.tissues) {
      if (tissue.friedman) {
        p.push_back(tissue.friedman->p);
        continue;
      }
      for (const EstimatedPair& pair : tissue.pairs) p.push_back(pair.p);
    }
    if (p.empty()) {
      result_.main_test = "no test of people: fewer than two subjects answered about every sample";
      return;
    }
    const std::vector<double> adjusted = psychophysics::holm(p);
    result_.p_value = *std::ranges::min_element(adjusted);
    const char* least = p.size() > 1 ? ", the least after Holm" : "";
    if (result_.of_magnitudes) {
      result_.main_test = fmt::format("Student's t of the subjects' ln ratios against 1{}", least);
    } else {
      const bool ranks =
          std::ranges::any_of(result_.tissues, [](const auto& it) { return it.friedman.has_value(); });
      result_.main_test = fmt::format("{}{}",
                                      ranks ? "Friedman's of the subjects' mean ratings"
                                            : "flipped signs of the subjects' differences, two-sided",
                                      least);
    }
  }

  void name_law_test() {
    if (result_.law && result_.law->mean) {
      result_.p_value = result_.law->p_of_one;
      result_.main_test = "Student's t of the subjects' exponents against 1";
    } else {
      result_.main_test = "no test of people: fewer than two subjects have an exponent";
    }
  }

  const Study& study_;
  const Answers& judgements_;
  const AnalysisOptions& options_;
  EstimateAnalysis result_;
  std::vector<SubjectMeans> means_;  ///< of all tissues
};

}  // namespace

std::optional<EstimateAnalysis> analyse_estimates(const Study& study, const Answers& judgements,
                                                  const AnalysisOptions& options) {
  if (!asks_numbers(study.design) || judgements.empty()) return std::nullopt;
  return Estimating(study, judgements, options).analysed();
}

}  // namespace kerf::bench
