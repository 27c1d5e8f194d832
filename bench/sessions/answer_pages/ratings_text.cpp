#include "answer_pages/ratings_text.h"

#include <vector>

#include <fmt/core.h>

#include "answer_pages/analysis_words.h"
#include "answer_pages/levels_json.h"
#include "files/json_number.h"
#include "html/html.h"

namespace kerf::bench {
namespace {

/// Pairs of false-alarm and hit rate.
nlohmann::ordered_json points_as_json(const psychophysics::Ratings& ratings) {
  auto points = nlohmann::ordered_json::array();
  for (const RocPoint& point : roc_points(ratings))
    points.push_back({json_number(point.false_alarm_rate), json_number(point.hit_rate)});
  return points;
}

nlohmann::ordered_json rating_group_as_json(const RatingGroup& group) {
  nlohmann::ordered_json result{
      {"name", group.name},
      {"noise", group.ratings.noise},
      {"signal", group.ratings.signal},
      {"points", points_as_json(group.ratings)},
      {"area", nullptr},
      {"normal", nullptr},
      {"note", group.note.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(group.note)}};
  if (group.area) {
    result["area"] = {{"value", json_number(group.area->value)},
                      {"std_error", json_number(group.area->standard_error)},
                      {"ci95", pair_of(group.area->interval)}};
  }
  if (group.fit) {
    const psychophysics::NormalRoc& fit = *group.fit;
    result["normal"] = {{"d_a", json_number(fit.d_a)},
                        {"d_a_std_error", json_number(fit.d_a_error)},
                        {"d_a_ci95", pair_of(fit.d_a_interval)},
                        {"area", json_number(fit.area)},
                        {"mean", json_number(fit.mean)},
                        {"deviation", json_number(fit.deviation)},
                        {"log_deviation_std_error", json_number(fit.log_deviation_error)},
                        {"criteria", json_numbers(fit.criteria)},
                        {"log_likelihood", json_number(fit.log_likelihood)},
                        {"deviance", json_number(fit.deviance)},
                        {"degrees_of_freedom", fit.degrees_of_freedom},
                        {"equal_variances_p", json_number(group.equal_variances_p)}};
  }
  return result;
}

std::vector<std::string> row_of_group(const RatingGroup& group) {
  const auto or_none = [](bool is_known, const std::string& text) {
    return is_known ? text : std::string("-");
  };
  return {group.name,
          group.area ? fmt::format("{:.3f}", group.area->value) : "-",
          group.area ? fmt::format("{:.3f} to {:.3f}", group.area->interval.lower, group.area->interval.upper)
                     : "-",
          group.fit ? d_prime_text(group.fit->d_a) : "-",
          group.fit ? d_prime_text(group.fit->d_a_interval) : "-",
          group.fit ? fmt::format("{:.2f}", group.fit->deviation) : "-",
          or_none(group.equal_variances_p.has_value(), p_text(group.equal_variances_p.value_or(1.0))),
          or_none(!group.note.empty(), group.note)};
}

}  // namespace

nlohmann::ordered_json ratings_as_json(const RatingAnalysis& analysis) {
  nlohmann::ordered_json result{{"all", rating_group_as_json(analysis.all)},
                                {"by_subject", nlohmann::ordered_json::array()},
                                {"over_subjects", nullptr}};
  for (const RatingGroup& subject : analysis.by_subject)
    result["by_subject"].push_back(rating_group_as_json(subject));
  if (analysis.over_subjects) {
    result["over_subjects"] = {{"mean_area", json_number(0.5 + analysis.over_subjects->mean)},
                               {"p_greater", json_number(analysis.over_subjects->p_greater)},
                               {"p_two_sided", json_number(analysis.over_subjects->p_two_sided)}};
  }
  return result;
}

std::string rating_section(const RatingAnalysis& analysis) {
  std::vector<std::vector<std::string>> rows{
      {"subject", "area", "interval", "d_a", "interval", "deviation of the signal", "equal variances", ""}};
  rows.push_back(row_of_group(analysis.all));
  for (const RatingGroup& subject : analysis.by_subject) rows.push_back(row_of_group(subject));
  std::string html = "<h2>Confidence</h2>\n" + html_table(rows);
  if (analysis.over_subjects) {
    html += fmt::format(
        "<p class=\"soft\">Mean of the subjects' areas {:.3f}: {} by flipped signs, one-sided. The curve of "
        "all is "
        "flatter than theirs where their criteria differ.</p>\n",
        0.5 + analysis.over_subjects->mean, escaped(p_text(analysis.over_subjects->p_greater)));
  }
  return html;
}

}  // namespace kerf::bench
