#pragma once

#include <algorithm>
#include <initializer_list>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "laws/law_file.h"

namespace kerf::bench {

/// Parses TOML. @throws std::invalid_argument with `name` and the line.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& name);

/// On which terms a law file takes the plug-in that it names.
struct PluginTerms {
  std::string_view advice = "which is not given: --plugin PATH/";  ///< where it is missing, before its name
  /// Where a law is not known and the file names no plug-in.
  std::string_view of_unknown = "one of a plug-in is known with --plugin PATH/FILE.so";
  bool of_any_content = true;  ///< another content of the same law is told among take_plugin_notes()
};

/// As parse_law_file() of law_file.h, on other terms.
[[nodiscard]] LawFile parse_law_file(const std::string& text, const std::string& name,
                                     const PluginTerms& terms);

/// A law that stands in a table of a larger file, such as the tissue of a scene, with keys that the larger
/// file has `beside` it. Messages as in parse_law_file().
[[nodiscard]] LawFile law_from_table(const toml::table& table, const std::string& name,
                                     std::initializer_list<std::string_view> beside = {},
                                     const PluginTerms& terms = {});

/// Numbers with their unit, in SI.
struct Measured {
  std::vector<double> values;
  std::vector<double> std_errors;  ///< as many, or none
};

/// Reads the nodes of one file, and refuses them with file and line. Every member throws
/// std::invalid_argument for a node that is not as asked for.
class Place {
 public:
  explicit Place(std::string file) : file_(std::move(file)) {}
  [[nodiscard]] const std::string& file() const noexcept { return file_; }

  template <typename... Arguments>
  [[noreturn]] void refuse(const toml::node& node, fmt::format_string<Arguments...> format,
                           Arguments&&... arguments) const {
    throw std::invalid_argument(fmt::format("{}:{}: {}", file_, line_of(node),
                                            fmt::format(format, std::forward<Arguments>(arguments)...)));
  }

  void allow_only(const toml::table& table, std::span<const std::string_view> keys,
                  std::string_view where) const;
  void allow_only(const toml::table& table, std::initializer_list<std::string_view> keys,
                  std::string_view where) const {
    allow_only(table, std::span(keys.begin(), keys.size()), where);
  }
  [[nodiscard]] const toml::table& table(const toml::table& parent, std::string_view key) const;
  [[nodiscard]] std::string text(const toml::table& parent, std::string_view key,
                                 std::string_view standard) const;
  [[nodiscard]] double number(const toml::node& node, std::string_view what) const;
  [[nodiscard]] bool flag(const toml::table& parent, std::string_view key, bool standard) const;

  /// `{ value = ..., unit = "...", std_error = ... }`, the value a number or an array of them, converted to
  /// `expected`, an SI unit.
  [[nodiscard]] Measured measured(const toml::node& node, const std::string& name,
                                  const std::string& expected) const;

 private:
  /// A file without anything in it begins at line 1 too.
  static toml::source_index line_of(const toml::node& node) {
    return std::max<toml::source_index>(node.source().begin.line, 1);
  }
  std::string file_;
};

}  // namespace kerf::bench
