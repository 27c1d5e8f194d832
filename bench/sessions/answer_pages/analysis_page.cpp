#include "answer_pages/analysis_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "answer_pages/analysis_charts.h"
#include "answer_pages/analysis_json.h"
#include "answer_pages/analysis_words.h"
#include "answer_pages/estimates_text.h"
#include "answer_pages/experiment_words.h"
#include "answer_pages/explored_words.h"
#include "answer_pages/felt_words.h"
#include "answer_pages/ratings_text.h"
#include "answers/answers_table.h"
#include "files/json_file.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "html/html.h"
#include "protocol/questionnaire/questionnaire_table.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_unbroken = 24;  ///< characters of a cell that stay on one line

using Rows = std::vector<std::vector<std::string>>;

std::string list_of(const char* title, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return {};
  std::string html = fmt::format("<h2>{}</h2>\n<ul>\n", title);
  for (const std::string& sentence : sentences) html += fmt::format("<li>{}</li>\n", escaped(sentence));
  return html + "</ul>\n";
}

std::string bare(const std::string& p) {
  return p.starts_with("p = ") ? p.substr(4) : p.starts_with("p < ") ? p.substr(2) : "-";
}

/// Numbers stay with their units at the end of a line, and columns that hold nothing are left out.
std::string table_of(const Rows& rows) {
  Rows kept(rows.size());
  for (std::size_t column = 0; column < rows.front().size(); ++column) {
    const bool is_empty = column > 0 && std::all_of(rows.begin() + 1, rows.end(), [&](const auto& row) {
                            return row[column].empty() || row[column] == "-";
                          });
    if (is_empty) continue;
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::string& whole = rows[row][column];
      const bool is_short = row > 0 && whole.size() < max_unbroken;
      std::string cell;
      for (const char c : whole) cell += is_short && c == ' ' ? std::string("\u00a0") : std::string(1, c);
      kept[row].push_back(std::move(cell));
    }
  }
  return html_table(kept);
}

void add_rows(Rows& rows, const std::vector<AnswerGroup>& groups, const char* kind, bool is_family) {
  for (const AnswerGroup& group : groups) {
    const auto [k, n] = group.count;
    rows.push_back({kind[0] == '\0' ? group.name : fmt::format("{} {}", kind, group.name),
                    fmt::format("{} of {}", k, n), percent_text(static_cast<double>(k) / n),
                    percent_text(group.interval), percent_text(group.wilson), bare(p_text(group.p_value)),
                    is_family ? bare(p_text(group.p_adjusted)) : std::string("-"),
                    group.d_prime ? d_prime_text(group.d_prime->value) : std::string("-"),
                    group.d_prime ? d_prime_text(group.d_prime->interval) : std::string("-"),
                    group.d_prime                 ? d_prime_text(group.excluded_d_prime)
                    : group.excluded_margin > 0.0 ? fmt::format("+- {}", percent_text(group.excluded_margin))
                                                  : std::string("-")});
  }
}

std::string count_table(const Analysis& analysis) {
  const double confidence = 100.0 * analysis.options.confidence;
  Rows rows{{"", "count", "share", fmt::format("{:.3g} % (Clopper-Pearson)", confidence),
             fmt::format("{:.3g} % (Wilson)", confidence), "p",
             analysis.options.correction == FamilyCorrection::holm ? "p (Holm)" : "p (Benjamini-Hochberg)",
             "d'", fmt::format("d', {:.3g} %", confidence),
             fmt::format("excluded at {:.3g} %, beyond", 100.0 * analysis.options.level)}};
  if (analysis.all) add_rows(rows, {*analysis.all}, "", false);
  if (analysis.by_tissue.size() > 1) add_rows(rows, analysis.by_tissue, "", true);
  add_rows(rows, analysis.by_pair, "", true);
  if (analysis.by_subject.size() > 1) add_rows(rows, analysis.by_subject, "subject", true);
  return rows.size() > 1 ? table_of(rows) : std::string();
}

std::string power_table(const AnswerGroup& all) {
  if (all.power.empty()) return {};
  Rows rows{{"if in truth", "chance to notice it with these answers", "answers for a chance of 80 %"}};
  for (const TestPower& power : all.power) {
    rows.push_back({fmt::format("{:.3g} % {}", 100.0 * power.truth, all.counted),
                    fmt::format("{:.0f} %", 100.0 * power.power),
                    power.trials_needed > 0 ? fmt::format("{}", power.trials_needed) : std::string("-")});
  }
  return html_table(rows);
}

void add_fit(Rows& rows, const LevelFit& fit) {
  std::string notes;
  for (const std::string& note : fit.notes) notes += (notes.empty() ? "" : "; ") + note;
  const auto value = [](const std::optional<psychophysics::Threshold>& found) {
    return found ? fmt::format("{} ({})", percent_text(found->value), percent_text(found->interval))
                 : std::string("-");
  };
  rows.push_back({fit.name, value(fit.jnd), value(fit.equality),
                  fit.fit ? fmt::format("{:.3g}", fit.fit->slope) : std::string("-"),
                  fit.fit ? percent_text(fit.fit->curve.lapse) : std::string("-"),
                  fit.fit ? fmt::format("{:.1f} on {}", fit.fit->deviance, fit.fit->degrees_of_freedom)
                          : std::string("-"),
                  fit.bootstrap ? bare(p_text(fit.bootstrap->deviance_p)) : std::string("-"), notes});
}

std::string level_section(const Analysis& analysis) {
  const LevelAnalysis& levels = *analysis.levels;
  Rows rows{
      {"", "JND (interval)", "PSE (interval)", "slope", "lapses", "deviance", "p of the deviance", "note"}};
  add_fit(rows, levels.pooled);
  for (const LevelFit& subject : levels.by_subject) add_fit(rows, subject);
  std::string html = fmt::format(
      "<p class=\"soft\">Fractions of the standard. {} {:.3g} % intervals by {}; a curve of shape "
      "{}.{}</p>\n",
      levels.two_sided
          ? "The JND is half the way from 25 to 75 %, the PSE where both are named equally often."
          : fmt::format("The JND is where {:.3g} % are right.",
                        levels.pooled.fit ? 100.0 * levels.pooled.fit->threshold.criterion : 75.0),
      100.0 * analysis.options.confidence,
      is_adaptive(analysis.design) ? "profile likelihood (all together) or posterior (each subject)"
                                   : "profile likelihood",
      name_of(levels.shape),
      levels.by_subject.empty()
          ? ""
          : " All together: with the spread between subjects and levels (beta-binomial).");
  html += table_of(rows);
  if (levels.shapes.size() > 1) {
    Rows shapes{{"shape", "AIC over the least", "deviance", "JND"}};
    double least = levels.shapes.front().aic;
    for (const ShapeFit& shape : levels.shapes) least = std::min(least, shape.aic);
    for (const ShapeFit& shape : levels.shapes) {
      shapes.push_back({name_of(shape.shape), fmt::format("{:.1f}", shape.aic - least),
                        fmt::format("{:.1f}", shape.deviance), percent_text(shape.jnd)});
    }
    html += "<details><summary>Other shapes of the curve, answers of a level together</summary>\n" +
            html_table(shapes) + "</details>\n";
  }
  return html;
}

std::string ranking_table(const TissueRanking& ranking, const Analysis& analysis) {
  std::string html =
      ranking.tissue.empty() ? std::string() : fmt::format("<p>{}</p>\n", escaped(ranking.tissue));
  if (!ranking.bradley_terry)
    return html + fmt::format("<p class=\"answer bad\">{}</p>\n", escaped(as_sentence(ranking.note)));
  Rows rows{{"pair", "worth apart", "standard error", "p", "p over all pairs"}};
  for (const RankedPair& pair : ranking.pairs) {
    rows.push_back({fmt::format("{} less {}", analysis.samples[ranking.samples[pair.first]],
                                analysis.samples[ranking.samples[pair.second]]),
                    fmt::format("{:+.2f}", pair.difference.value),
                    fmt::format("{:.2f}", pair.difference.standard_error), bare(p_text(pair.difference.p)),
                    bare(p_text(pair.p_adjusted))});
  }
  html += html_table(rows);
  return html + fmt::format("<p class=\"soft\">All equal: {}. One scale describes the answers: {}.</p>\n",
                            p_text(ranking.bradley_terry->ratio_p),
                            p_text(ranking.bradley_terry->deviance_p));
}

std::string bias_table(const SlotBias& bias, Design design) {
  if (!bias.note.empty()) return {};
  Rows rows{{has_two_rates(design) ? "answer" : "slot", "answered",
             design == Design::preference ? "the other preferred when there" : "right when it was right"}};
  for (std::size_t slot = 0; slot < bias.answers.size(); ++slot) {
    const auto [k, n] = bias.right_in[slot];
    rows.push_back({std::string(answer_label_of(design, slot)), fmt::format("{} times", bias.answers[slot]),
                    fmt::format("{} of {}", k, n)});
  }
  std::string text = fmt::format("Without a response bias the shares are equal: {}.", p_text(bias.test.p));
  if (bias.detection) {
    text += fmt::format(" With the response bias taken out d' is {} ({}), criterion {:+.2f} +- {:.2f} ({}).",
                        d_prime_text(bias.detection->d_prime), d_prime_text(bias.detection->interval),
                        bias.detection->criterion, bias.detection->criterion_standard_error,
                        has_two_rates(design)
                            ? fmt::format("the larger, the more often \"{}\"", answer_label_of(design, 0))
                            : std::string("below 0: to the first"));
  }
  return "<h2>Response bias</h2>\n" + html_table(rows) +
         fmt::format("<p class=\"soft\">{}</p>\n", escaped(text));
}

}  // namespace

std::string analysis_page(const Analysis& analysis, std::span<const std::string> drawings) {
  std::string body = fmt::format(
      "<h1>{}</h1>\n<p class=\"soft\">{}: {} of {}{}.</p>\n", escaped(analysis.name),
      name_of(analysis.design), plural(analysis.trials, "trial"), plural(analysis.subjects.size(), "subject"),
      analysis.practice > 0 ? fmt::format(", {} of practice left out", analysis.practice) : std::string());
  if (analysis.experiment) body += experiment_section(*analysis.experiment);
  body += list_of("What the answers show", analysis.shows);
  body += list_of("What they do not show", analysis.shows_not);
  body += list_of("To be minded", analysis.warnings);
  if (!drawings.empty()) body += "<h2>Drawings</h2>\n";
  for (const std::string& drawing : drawings) body += html_figure(drawing);
  if (analysis.levels) body += "<h2>Psychometric functions</h2>\n" + level_section(analysis);
  if (analysis.estimates) body += estimates_section(analysis);
  if (analysis.ratings) body += rating_section(*analysis.ratings);
  if (!analysis.rankings.empty()) {
    body += "<h2>Ranking</h2>\n";
    for (const TissueRanking& ranking : analysis.rankings) body += ranking_table(ranking, analysis);
  }
  if ((analysis.all || !analysis.by_pair.empty()) && !(analysis.all && std::isnan(analysis.p_value))) {
    body +=
        fmt::format("<h2>Counts</h2>\n<p class=\"soft\">Main test: {}.</p>\n", escaped(analysis.main_test)) +
        count_table(analysis);
  }
  if (analysis.all) body += power_table(*analysis.all);
  if (analysis.trials > 0) body += bias_table(analysis.bias, analysis.design);
  body += questionnaire_section(analysis);
  body += felt_section(analysis.felt, analysis.samples, analysis.options.confidence);
  if (!analysis.catches.empty())
    body +=
        fmt::format("<h2>Attention</h2>\n<p>{}</p>\n", escaped(as_sentence(catches_text(analysis.catches))));
  body += explored_section(analysis.explored, analysis.samples, analysis.options.confidence);
  if (analysis.times.trials > 0)
    body += fmt::format("<h2>Times</h2>\n<p>{}</p>\n", escaped(as_sentence(times_text(analysis.times))));
  return html_page(analysis.name, body);
}

std::vector<std::string> write_analysis(const Study& study, const Analysis& analysis,
                                        const std::filesystem::path& folder, bool replace) {
  require_output(folder / "analysis.html", replace);
  const std::vector<Figure> figures = analysis_figures(study, analysis);
  std::vector<Chart> charts;
  for (const Figure& figure : figures) charts.push_back(figure.chart);
  const std::vector<std::string> drawings = charts.empty() ? std::vector<std::string>() : draw_all(charts);
  WholeFolder whole(folder, schema::existing_if(replace));
  std::vector<std::string> names{"analysis.html", "analysis.json", "answers.csv"};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    names.push_back(figures[i].name + ".svg");
    write_whole_file(whole.path() / names.back(), drawings[i] + "\n");
  }
  write_whole_file(whole.path() / "answers.csv", answers_csv(study));
  if (!study.questionnaires.empty()) {
    names.emplace_back("questionnaire.csv");
    write_whole_file(whole.path() / "questionnaire.csv", questionnaire_csv(study));
  }
  write_json_file(whole.path() / "analysis.json", analysis_as_json(analysis));
  write_whole_file(whole.path() / "analysis.html", analysis_page(analysis, drawings));
  whole.commit();
  return names;
}

}  // namespace kerf::bench
