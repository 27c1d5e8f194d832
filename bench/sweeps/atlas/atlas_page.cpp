#include "atlas/atlas_page.h"

#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "atlas/atlas_answer.h"
#include "atlas/pictures/axis_ticks.h"
#include "html/html.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

/// "18 values, 0.02 to 2", "kelvin, maxwell"
std::string values_in_words(SweepAtlas& atlas, std::size_t table, std::size_t column) {
  const AtlasColumn& about = atlas.tables()[table].columns[column];
  constexpr std::size_t few = 6;
  if (about.is_listed() && (about.is_text() || about.texts.size() <= few)) {
    std::string text;
    for (std::size_t i = 0; i < about.texts.size() && i < few; ++i)
      text += fmt::format("{}{}", i == 0 ? "" : ", ", about.texts[i].empty() ? "-" : about.texts[i]);
    return about.texts.size() > few ? fmt::format("{} values: {}, ...", about.texts.size(), text) : text;
  }
  const AtlasSpan span = span_of(atlas, table, column);
  if (span.known == 0) return "no number is known";
  const std::string range = fmt::format("{} to {}", short_number(span.smallest), short_number(span.largest));
  return about.is_listed() ? fmt::format("{} values, {}", about.texts.size(), range) : range;
}

std::string columns_table(SweepAtlas& atlas, std::size_t table) {
  const AtlasTable& of = atlas.tables()[table];
  std::vector<std::vector<std::string>> rows{{"column", "unit", "what", "values", "without a number"}};
  for (std::size_t i = 0; i < of.columns.size(); ++i) {
    const AtlasColumn& column = of.columns[i];
    const bool result = !column.is_input;
    const std::size_t unknown = result ? of.computed - span_of(atlas, table, i).known : 0;
    rows.push_back({column.name, column.unit, column.what, values_in_words(atlas, table, i),
                    result && unknown > 0 ? fmt::format("{}", unknown) : ""});
  }
  return fmt::format("<details><summary>The columns of {}</summary>\n{}</details>\n", escaped(of.name),
                     html_table(rows));
}

std::string cells_paragraph(SweepAtlas& atlas) {
  std::vector<std::vector<std::string>> rows{{"table", "computed", "failed", "missing"}};
  bool all_there = true;
  for (const AtlasTable& table : atlas.tables()) {
    rows.push_back({table.name, fmt::format("{}", table.computed), fmt::format("{}", table.failed.size()),
                    fmt::format("{}", table.missing.size())});
    all_there = all_there && table.failed.empty() && table.missing.empty();
  }
  const std::string text =
      all_there ? fmt::format("<strong>All {} cells were computed.</strong>", atlas.plan().cells())
                : fmt::format(
                      "<strong>Of {} cells some failed or are missing.</strong> failed.csv and "
                      "missing.csv beside the sweep name them; no picture takes them for values.",
                      atlas.plan().cells());
  return html_answer(all_there ? Answer::good : Answer::partly, text) + html_table(rows);
}

}  // namespace

std::string atlas_page(SweepAtlas& atlas, const std::vector<AtlasPicture>& pictures,
                       const std::vector<DrawnPicture>& drawn) {
  const std::filesystem::path folder = std::filesystem::absolute(atlas.file()).parent_path();
  const std::string name = folder.stem().string();
  std::string body =
      fmt::format("<h1>{}</h1>\n<p class=\"soft\">A sweep of <code>kerf {}</code>, computed by {}</p>\n",
                  escaped(name), atlas.plan().verb->name, escaped(atlas.software()));
  body += cells_paragraph(atlas);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    body += fmt::format("<h2>{}</h2>\n{}<p class=\"soft\">{}</p>\n", escaped(pictures[i].title),
                        html_figure(drawn[i].svg), escaped(drawn[i].caption));
  }
  body += "<h2>Columns</h2>\n";
  for (std::size_t table = 0; table < atlas.tables().size(); ++table) body += columns_table(atlas, table);
  return html_page(name, body);
}

}  // namespace kerf::bench
