#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include "kerf/drivers/device.h"

namespace kerf::drivers {

/// What the readers of a TOML file have in common: they say in which file and line what is wrong.
class TomlReader {
 protected:
  TomlReader(const toml::table& root, const std::string& name) : root_(root), name_(name) {}

  template <typename... Arguments>
  [[noreturn]] void refuse(const toml::node& node, fmt::format_string<Arguments...> format,
                           Arguments&&... arguments) const {
    const auto line = std::max<toml::source_index>(node.source().begin.line, 1);
    throw DeviceError(
        fmt::format("{}:{}: {}", name_, line, fmt::format(format, std::forward<Arguments>(arguments)...)));
  }

  template <typename Keys>
  void allow_only_these(const toml::table& table, const Keys& keys, std::string_view where) const {
    for (const auto& [key, node] : table) {
      if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
      refuse(node, "unknown key '{}' in {}; known are {}", key.str(), where,
             fmt::join(keys.begin(), keys.end(), ", "));
    }
  }
  void allow_only(const toml::table& table, std::initializer_list<std::string_view> keys,
                  std::string_view where) const {
    allow_only_these(table, keys, where);
  }
  void allow_only(const toml::table& table, const std::vector<std::string_view>& keys,
                  std::string_view where) const {
    allow_only_these(table, keys, where);
  }

  const toml::node& required(const toml::table& table, std::string_view key,
                             std::string_view expected) const {
    const toml::node* node = table.get(key);
    if (node == nullptr) refuse(table, "'{}' is missing; expected {}", key, expected);
    return *node;
  }
  const toml::table& table(const toml::node& node, std::string_view expected) const {
    if (!node.is_table()) refuse(node, "{}", expected);
    return *node.as_table();
  }
  std::string text(const toml::node& node, std::string_view key) const {
    if (!node.is_string()) refuse(node, "'{}' must be a text in quotes", key);
    return **node.as_string();
  }
  std::string optional_text(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    return node == nullptr ? std::string() : text(*node, key);
  }
  bool flag(const toml::node& node, std::string_view key) const {
    if (!node.is_boolean()) refuse(node, "'{}' must be true or false", key);
    return **node.as_boolean();
  }
  double number(const toml::node& node, std::string_view what, bool may_be_infinite = false) const {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || std::isnan(*value) || (std::isinf(*value) && !may_be_infinite))
      refuse(node, "{} must be a {}number", what, may_be_infinite ? "" : "finite ");
    return *value;
  }

  const toml::table& root_;
  const std::string& name_;
};

}  // namespace kerf::drivers
