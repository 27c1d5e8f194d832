#include "protocol/apparatus.h"

#include <fmt/core.h>

#include "protocol/protocol_parts.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_checks = 20;

void add_item(const Place& place, const toml::table& table, std::string_view key, Apparatus& apparatus) {
  if (!table.contains(key)) return;
  const std::string what = read_plain_text(place, table, key);
  if (what.empty()) place.refuse(*table.get(key), "'{}' is empty, expected what there is, in words", key);
  apparatus.items.push_back({.name = std::string(key), .what = what});
}

void add_checks(const Place& place, const toml::table& table, Apparatus& apparatus) {
  const toml::node* const node = table.get("checks");
  if (node == nullptr) return;
  const toml::array* const checks = node->as_array();
  if (checks == nullptr || checks->empty() || checks->size() > most_checks ||
      !checks->is_homogeneous<std::string>())
    place.refuse(*node, "'checks' has to be a list of 1 to {} texts", most_checks);
  for (std::size_t i = 0; i < checks->size(); ++i) {
    // Each as a table of its own, so that the same is asked of it as of every text.
    const toml::table one{{"checks", (*checks)[i].value_or(std::string())}};
    const std::string what = read_plain_text(place, one, "checks");
    if (what.empty()) place.refuse((*checks)[i], "a check is empty, expected what is to be so, in words");
    apparatus.items.push_back({.name = fmt::format("check {}", i + 1), .what = what});
  }
}

}  // namespace

std::string_view name_of(MaskingNoise noise) noexcept {
  switch (noise) {
    case MaskingNoise::none:
      return "none";
    case MaskingNoise::white:
      return "white";
    case MaskingNoise::pink:
      return "pink";
  }
  return "none";
}

Apparatus read_apparatus(const Place& place, const toml::table& root) {
  Apparatus apparatus;
  if (!root.contains("apparatus")) return apparatus;
  const toml::table& table = place.table(root, "apparatus");
  place.allow_only(table, {"noise", "headphones", "occlusion", "hand_support", "checks"}, "[apparatus]");
  apparatus.noise = read_choice(
      place, table, "noise", MaskingNoise::none,
      {{"none", MaskingNoise::none}, {"white", MaskingNoise::white}, {"pink", MaskingNoise::pink}});
  for (const std::string_view key : {"headphones", "occlusion", "hand_support"})
    add_item(place, table, key, apparatus);
  add_checks(place, table, apparatus);
  return apparatus;
}

}  // namespace kerf::bench
