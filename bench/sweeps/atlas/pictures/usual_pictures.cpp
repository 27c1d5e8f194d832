#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "atlas/atlas_answer.h"
#include "atlas/pictures/atlas_picture.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_results = 4;
constexpr std::size_t most_panels = 6;

/// Inputs that are varied and listed, those with most values first.
std::vector<const AtlasColumn*> varied_inputs(const AtlasTable& table) {
  std::vector<const AtlasColumn*> inputs;
  for (const AtlasColumn& column : table.columns)
    if (column.is_input && column.texts.size() > 1) inputs.push_back(&column);
  std::ranges::stable_sort(inputs, std::ranges::greater(),
                           [](const AtlasColumn* one) { return one->texts.size(); });
  return inputs;
}

/// Results that are not the same everywhere.
std::vector<std::string> varied_results(SweepAtlas& atlas, std::size_t table) {
  std::vector<std::string> results;
  const auto& columns = atlas.tables()[table].columns;
  for (std::size_t i = 0; i < columns.size() && results.size() < most_results; ++i) {
    if (columns[i].is_input) continue;
    const AtlasSpan span = span_of(atlas, table, i);
    if (span.known > 0 && span.smallest < span.largest) results.push_back(columns[i].name);
  }
  return results;
}

std::string named(const AtlasTable& table, const std::string& what) {
  std::string name = fmt::format("{}-{}", table.name, what);
  std::ranges::replace(name, '/', '_');
  return name;
}

}  // namespace

std::vector<AtlasPicture> usual_pictures(SweepAtlas& atlas) {
  std::vector<AtlasPicture> pictures;
  for (std::size_t number = 0; number < atlas.tables().size(); ++number) {
    const AtlasTable& table = atlas.tables()[number];
    const std::vector<const AtlasColumn*> inputs = varied_inputs(table);
    const std::vector<std::string> results = varied_results(atlas, number);
    if (inputs.empty() || results.empty()) continue;
    for (const std::string& result : results) {
      AtlasPicture picture{
          .kind = inputs.size() > 1 ? AtlasPicture::Kind::map : AtlasPicture::Kind::lines,
          .name = named(table, result),
          .title = fmt::format("{}: mean {}", table.name, result),
          .question = {.table = table.name, .by = {}, .of = result, .share = {}, .where = {}}};
      for (const AtlasColumn* const input : inputs) {
        if (picture.question.by.size() == 4) break;
        if (picture.question.by.size() >= 2 && input->texts.size() > most_panels) continue;
        picture.question.by.push_back(input->name);
      }
      pictures.push_back(std::move(picture));
    }
    AtlasPicture parallel{
        .kind = AtlasPicture::Kind::parallel,
        .name = named(table, "parallel"),
        .title = fmt::format("{}: cells by chance, in the colour of {}", table.name, results.front()),
        .question = {.table = table.name, .by = {}, .of = results.front(), .share = {}, .where = {}}};
    for (const AtlasColumn* const input : inputs)
      if (parallel.columns.size() < 6) parallel.columns.push_back(input->name);
    parallel.columns.insert(
        parallel.columns.end(), results.begin(),
        results.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(results.size(), 2)));
    if (parallel.columns.size() > 1) pictures.push_back(std::move(parallel));
  }
  return pictures;
}

}  // namespace kerf::bench
