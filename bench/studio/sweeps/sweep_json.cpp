#include "sweeps/sweep_json.h"

#include <iterator>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "files/json_number.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

nlohmann::ordered_json column_json(SweepAtlas& atlas, std::size_t table, std::size_t number) {
  const AtlasColumn& column = atlas.tables()[table].columns[number];
  return {{"name", column.name},      {"unit", column.unit},   {"what", column.what},
          {"input", column.is_input}, {"texts", column.texts}, {"values", json_numbers(column.values)}};
}

nlohmann::ordered_json axis_json(const AtlasAxis& axis) {
  return {{"column", axis.column},
          {"unit", axis.unit},
          {"names", axis.names},
          {"values", json_numbers(axis.values)},
          {"edges", json_numbers(axis.edges)},
          {"logarithmic", axis.is_logarithmic()}};
}

nlohmann::ordered_json tile_json(const AtlasTile& tile) {
  return {
      {"computed", tile.computed}, {"known", tile.known}, {"failed", tile.failed}, {"missing", tile.missing}};
}

/// Counts of all tiles, one after the other.
void append_counts(std::string& text, const char* name, const std::vector<AtlasTile>& tiles,
                   std::uint32_t AtlasTile::*count) {
  fmt::format_to(std::back_inserter(text), ",\"{}\":[", name);
  for (std::size_t i = 0; i < tiles.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{}{}", i == 0 ? "" : ",", tiles[i].*count);
  text += ']';
}

/// A JSON object whose last brace is taken off, for what is long.
std::string begun(const nlohmann::ordered_json& object) {
  std::string text = object.dump();
  text.pop_back();
  return text;
}

}  // namespace

std::string sweep_json(SweepAtlas& atlas) {
  nlohmann::ordered_json all{{"verb", atlas.plan().verb->name},
                             {"what", atlas.plan().verb->what},
                             {"software", atlas.software()},
                             {"cells", atlas.plan().cells()},
                             {"tables", nlohmann::ordered_json::array()}};
  for (std::size_t table = 0; table < atlas.tables().size(); ++table) {
    const AtlasTable& of = atlas.tables()[table];
    nlohmann::ordered_json columns = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < of.columns.size(); ++i) columns.push_back(column_json(atlas, table, i));
    all["tables"].push_back({{"name", of.name},
                             {"computed", of.computed},
                             {"failed", of.failed.size()},
                             {"missing", of.missing.size()},
                             {"columns", columns}});
  }
  return all.dump();
}

std::string answer_json(const AtlasAnswer& answer) {
  nlohmann::ordered_json about{
      {"unit", answer.unit}, {"all", tile_json(answer.all)}, {"axes", nlohmann::ordered_json::array()}};
  for (const AtlasAxis& axis : answer.axes) about["axes"].push_back(axis_json(axis));
  std::string text = begun(about);
  std::vector<double> values;
  for (const AtlasTile& tile : answer.tiles) values.push_back(tile.value);
  text += ",\"value\":";
  append_json_numbers(text, values);
  append_counts(text, "computed", answer.tiles, &AtlasTile::computed);
  append_counts(text, "known", answer.tiles, &AtlasTile::known);
  append_counts(text, "failed", answer.tiles, &AtlasTile::failed);
  append_counts(text, "missing", answer.tiles, &AtlasTile::missing);
  return text + "}";
}

std::string sample_json(const AtlasSample& sample) {
  nlohmann::ordered_json about{
      {"of", sample.of}, {"state", sample.state}, {"columns", nlohmann::ordered_json::array()}};
  for (const AtlasColumn& column : sample.columns) about["columns"].push_back(column.name);
  std::string text = begun(about) + ",\"values\":[";
  for (std::size_t i = 0; i < sample.values.size(); ++i) {
    if (i > 0) text += ',';
    append_json_numbers(text, sample.values[i]);
  }
  return text + "]}";
}

}  // namespace kerf::bench
