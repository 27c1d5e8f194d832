#include "protocol/protocol_parts.h"

#include <cmath>

namespace kerf::bench {
namespace {

constexpr std::size_t longest_name = 60;

}  // namespace

const toml::node& node_or_table(const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  return node != nullptr ? *node : table;
}

std::string read_name(const Place& place, const toml::table& table, std::string_view what) {
  std::string name = read_plain_text(place, table, "name");
  if (name.empty()) place.refuse(node_or_table(table, "name"), "{} needs a 'name'", what);
  if (characters_in(name) > longest_name || name.front() == ' ' || name.back() == ' ') {
    place.refuse(*table.get("name"),
                 "'{}' is no name for {}; expected at most {} characters, no space at the ends", name, what,
                 longest_name);
  }
  return name;
}

double read_plain_number(const Place& place, const toml::table& table, const PlainNumber& about) {
  const toml::node* node = table.get(about.key);
  if (node == nullptr) return about.standard;
  const double value = place.number(*node, fmt::format("'{}'", about.key));
  if (!(value >= about.lower && value <= about.upper)) {
    place.refuse(*node, "'{}' is {:g}, expected a number from {:g} to {:.10g}", about.key, value, about.lower,
                 about.upper);
  }
  return value;
}

std::size_t read_count(const Place& place, const toml::table& table, const PlainNumber& about) {
  const double value = read_plain_number(place, table, about);
  if (value != std::floor(value))
    place.refuse(*table.get(about.key), "'{}' is {:g}, expected a whole number", about.key, value);
  return static_cast<std::size_t>(value);
}

}  // namespace kerf::bench
