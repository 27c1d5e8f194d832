#include "protocol/questionnaire/questionnaire.h"

#include <algorithm>

#include "protocol/protocol_parts.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_items = 20;

/// The six scales of NASA's Task Load Index: its own words in English, and for the subject theirs.
std::vector<QuestionnaireItem> task_load_index(const SubjectTexts& texts) {
  const std::array<std::string, 2> demand{texts("tlx_very_low"), texts("tlx_very_high")};
  return {{"Mental demand", texts("tlx_mental_demand"), demand},
          {"Physical demand", texts("tlx_physical_demand"), demand},
          {"Temporal demand", texts("tlx_temporal_demand"), demand},
          {"Performance", texts("tlx_performance"), {texts("tlx_perfect"), texts("tlx_failure")}},
          {"Effort", texts("tlx_effort"), demand},
          {"Frustration", texts("tlx_frustration"), demand}};
}

QuestionnaireItem read_item(const Place& place, const toml::table& table) {
  place.allow_only(table, {"name", "question", "ends"}, "a [[questionnaire.item]]");
  QuestionnaireItem item{.name = read_name(place, table, "a [[questionnaire.item]]"),
                         .question = read_plain_text(place, table, "question"),
                         .ends = {}};
  if (item.question.empty())
    place.refuse(node_or_table(table, "question"), "the item '{}' needs a 'question'", item.name);
  const toml::array* ends = table.get_as<toml::array>("ends");
  if (ends == nullptr || ends->size() != 2 || !ends->is_homogeneous<std::string>())
    place.refuse(node_or_table(table, "ends"),
                 "the item '{}' needs 'ends', an array of two texts such as [\"not at all\", \"very\"]",
                 item.name);
  for (std::size_t end = 0; end < 2; ++end) {
    const toml::table one{{"ends", (*ends)[end].value_or(std::string())}};
    item.ends[end] = read_plain_text(place, one, "ends");
    if (item.ends[end].empty() || item.ends[end].size() > 40)
      place.refuse((*ends)[end], "'{}' is no word for an end; expected 1 to 40 characters", item.ends[end]);
  }
  return item;
}

}  // namespace

Questionnaire read_questionnaire(const Place& place, const toml::table& root, const SubjectTexts& texts) {
  Questionnaire asked;
  if (!root.contains("questionnaire")) return asked;
  const toml::table& table = place.table(root, "questionnaire");
  place.allow_only(table, {"use", "after", "item"}, "[questionnaire]");
  asked.after_blocks = read_choice(place, table, "after", true, {{"block", true}, {"end", false}});
  if (table.contains("use") == table.contains("item"))
    place.refuse(table, "[questionnaire] needs use = \"nasa-tlx\" or one [[questionnaire.item]] and more");
  if (table.contains("use")) {
    (void)read_choice(place, table, "use", true, {{"nasa-tlx", true}});
    asked.use = "nasa-tlx";
    asked.items = task_load_index(texts);
    return asked;
  }
  const toml::array* items = table.get_as<toml::array>("item");
  if (items == nullptr || items->empty() || items->size() > most_items ||
      !items->is_homogeneous<toml::table>())
    place.refuse(*table.get("item"), "expected one [[questionnaire.item]] to {} of them", most_items);
  for (const toml::node& node : *items) {
    QuestionnaireItem item = read_item(place, *node.as_table());
    if (std::ranges::count(asked.items, item.name, &QuestionnaireItem::name) > 0)
      place.refuse(node, "there are two items named '{}'", item.name);
    asked.items.push_back(std::move(item));
  }
  return asked;
}

}  // namespace kerf::bench
