#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "atlas/pictures/atlas_picture.h"
#include "files/named_file.h"
#include "laws/law_toml.h"

namespace kerf::bench {
namespace {

using Kind = AtlasPicture::Kind;

constexpr std::array<std::pair<std::string_view, Kind>, 4> kinds{
    {{"map", Kind::map}, {"lines", Kind::lines}, {"shares", Kind::shares}, {"parallel", Kind::parallel}}};

std::vector<std::string> texts_in(const Place& place, const toml::table& table, std::string_view key) {
  std::vector<std::string> texts;
  const toml::node* const node = table.get(key);
  if (node == nullptr) return texts;
  const auto take = [&](const toml::node& one) {
    const auto text = one.value_exact<std::string>();
    if (!text) place.refuse(one, "'{}' is a name, or a list of them", key);
    texts.push_back(*text);
  };
  if (const toml::array* const list = node->as_array()) {
    for (const auto& one : *list) take(one);
  } else {
    take(*node);
  }
  return texts;
}

/// A value as the atlas lists it: numbers by the fewest digits.
std::string listed_value(const Place& place, const toml::node& node, std::string_view column) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  return value_text(place.number(node, column));
}

std::vector<AtlasFilter> filters_in(const Place& place, const toml::table& parent) {
  std::vector<AtlasFilter> filters;
  if (parent.get("where") == nullptr) return filters;
  for (const auto& [key, node] : place.table(parent, "where")) {
    AtlasFilter filter{.column = std::string(key.str())};
    if (const toml::table* const range = node.as_table()) {
      place.allow_only(*range, {"from", "to"}, "a range");
      if (const toml::node* const from = range->get("from")) filter.lower = place.number(*from, "from");
      if (const toml::node* const to = range->get("to")) filter.upper = place.number(*to, "to");
    } else if (const toml::array* const list = node.as_array()) {
      for (const auto& one : *list) filter.among.push_back(listed_value(place, one, filter.column));
    } else {
      filter.among.push_back(listed_value(place, node, filter.column));
    }
    filters.push_back(std::move(filter));
  }
  return filters;
}

/// Runs what reads a text. @throws with the place of its node.
template <typename Read>
auto read_at(const Place& place, const toml::node& node, const Read& read) {
  try {
    return read();
  } catch (const std::invalid_argument& error) {
    place.refuse(node, "{}", error.what());
  }
}

void read_measure(const Place& place, const toml::table& table, AtlasQuestion& question) {
  const std::string share = place.text(table, "share", "");
  question.of = place.text(table, "of", "");
  if (share.empty() == question.of.empty())
    place.refuse(table, "a picture has either 'of', a column, or 'share', a condition");
  if (!share.empty()) {
    question.statistic = AtlasStatistic::share;
    question.share = read_at(place, *table.get("share"), [&] { return parse_conditions(share); });
    return;
  }
  if (const toml::node* const statistic = table.get("statistic"))
    question.statistic =
        read_at(place, *statistic, [&] { return statistic_called(place.text(table, "statistic", "")); });
  if (question.is_share()) place.refuse(table, "a share is asked for by 'share', its condition");
}

void read_parts(const Place& place, const toml::table& table, AtlasPicture& picture) {
  const std::string x = place.text(table, "x", "");
  const std::string y = place.text(table, "y", "");
  if (x.empty()) place.refuse(table, "the picture '{}' needs 'x', a column", picture.title);
  picture.question.by.push_back(x);
  const bool is_map = picture.kind == Kind::map;
  if (is_map == y.empty())
    place.refuse(table, "{}",
                 is_map ? "a map needs 'y', a column" : "lines have no 'y'; 'of' is what they show");
  if (is_map) picture.question.by.push_back(y);
  for (std::string& one : texts_in(place, table, "by")) picture.question.by.push_back(std::move(one));
  if (picture.question.by.size() > (is_map ? 4U : 2U))
    place.refuse(*table.get("by"), "'by' has up to {} here", is_map ? "two columns" : "one column");
}

void read_shares(const Place& place, const toml::table& table, AtlasPicture& picture) {
  const toml::node* const node = table.get("shares");
  const toml::array* const list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr) place.refuse(table, "a picture of shares needs [[picture.shares]]");
  for (const auto& one : *list) {
    const toml::table* const part = one.as_table();
    if (part == nullptr) place.refuse(one, "expected [[picture.shares]]");
    place.allow_only(*part, {"name", "at", "share", "where"}, "a share");
    NamedShare share{
        .name = place.text(*part, "name", ""), .at = place.text(*part, "at", ""), .question = {}};
    share.question.table = picture.question.table;
    read_measure(place, *part, share.question);
    share.question.where = filters_in(place, *part);
    picture.shares.push_back(std::move(share));
  }
}

AtlasPicture picture_from(const Place& place, const toml::table& table, std::size_t number) {
  place.allow_only(table,
                   {"kind", "name", "title", "table", "x", "y", "by", "of", "statistic", "share", "where",
                    "steps", "nominal", "columns", "shares", "bins"},
                   "a picture");
  AtlasPicture picture;
  const std::string kind = place.text(table, "kind", "map");
  const auto found = std::ranges::find(kinds, kind, [](const auto& one) { return one.first; });
  if (found == kinds.end())
    place.refuse(*table.get("kind"), "'kind' is map, lines, shares or parallel, not '{}'", kind);
  picture.kind = found->second;
  picture.name = place.text(table, "name", fmt::format("picture-{}", number));
  picture.title = place.text(table, "title", "");
  picture.question.table = place.text(table, "table", "");
  if (picture.question.table.empty()) place.refuse(table, "a picture needs 'table', a table of the sweep");
  picture.question.where = filters_in(place, table);
  if (const toml::node* const nominal = table.get("nominal"))
    picture.nominal = place.number(*nominal, "nominal");
  if (const toml::node* const bins = table.get("bins")) {
    const double count = place.number(*bins, "bins");
    if (!(count >= 2.0 && count <= 400.0)) place.refuse(*bins, "'bins' is from 2 to 400");
    picture.question.bins = static_cast<std::size_t>(count);
  }
  if (const toml::node* const steps = table.get("steps")) {
    const toml::array* const list = steps->as_array();
    if (list == nullptr || list->size() < 2)
      place.refuse(*steps, "'steps' is a list of at least two numbers");
    for (const auto& one : *list) picture.steps.push_back(place.number(one, "steps"));
    if (std::ranges::adjacent_find(picture.steps, std::ranges::greater_equal()) != picture.steps.end())
      place.refuse(*steps, "'steps' increase");
  }
  if (picture.kind == Kind::shares) {
    read_shares(place, table, picture);
    return picture;
  }
  read_measure(place, table, picture.question);
  picture.columns = texts_in(place, table, "columns");
  if (picture.kind == Kind::parallel) {
    if (picture.columns.size() < 2) place.refuse(table, "parallel coordinates need 'columns', two or more");
  } else {
    read_parts(place, table, picture);
  }
  return picture;
}

}  // namespace

std::vector<AtlasPicture> read_pictures(const std::filesystem::path& file) {
  const toml::table root = parse_toml(read_named_file(file), file.string());
  const Place place(file.string());
  const toml::node* const version = root.get("version");
  if (version == nullptr || version->value<int>() != 1)
    place.refuse(root, "expected version = 1 of pictures");
  place.allow_only(root, {"version", "picture"}, "pictures of a sweep");
  const toml::node* const node = root.get("picture");
  const toml::array* const list = node == nullptr ? nullptr : node->as_array();
  if (list == nullptr || list->empty()) place.refuse(root, "expected [[picture]] for each picture");
  std::vector<AtlasPicture> pictures;
  std::set<std::string> names;
  for (const auto& one : *list) {
    const toml::table* const table = one.as_table();
    if (table == nullptr) place.refuse(one, "expected [[picture]] for each picture");
    pictures.push_back(picture_from(place, *table, pictures.size() + 1));
    const std::string& name = pictures.back().name;
    if (name.empty() || name.find_first_of("/\\") != std::string::npos || name.front() == '.' ||
        !names.insert(name).second)
      place.refuse(*table, "'name' is that of a file, and another for each picture");
  }
  return pictures;
}

}  // namespace kerf::bench
