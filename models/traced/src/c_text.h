#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "kerf/traced/program.h"

namespace kerf::traced {

/// Calls `f` for each node that an operation is of.
template <typename F>
void for_each_operand(const Noted& noted, F&& f) {
  // What an entry or a search begins with is the place of a table.
  const bool of_table = noted.operation == Operation::entry || noted.operation == Operation::segment_of;
  for (std::size_t i = of_table ? 1 : 0; i < noted.of.size() && noted.of[i] >= 0; ++i) f(noted.of[i]);
}

/// What stands for numbers in memory and tables.
class Names {
 public:
  Names(const Program& program, std::string_view law);
  [[nodiscard]] const std::string& law() const noexcept { return law_; }
  [[nodiscard]] bool has_ways() const noexcept { return has_ways_; }
  /// "s->displacement[3]", and "displacement_3" as part of another name.
  [[nodiscard]] const std::string& memory(std::size_t place) const { return memory_[place]; }
  [[nodiscard]] const std::string& plain(std::size_t place) const { return plain_[place]; }
  /// Numbers in a table.
  [[nodiscard]] std::size_t table_size(Node table) const {
    return table_sizes_[static_cast<std::size_t>(table)];
  }

 private:
  std::string law_;
  bool has_ways_ = false;
  std::vector<std::string> memory_;
  std::vector<std::string> plain_;
  std::vector<std::size_t> table_sizes_;
};
[[nodiscard]] std::string table_name(std::size_t table);

/// An expression of C.
struct Text {
  std::string text;
  int binds = 9;  ///< how tightly: what binds less stands in brackets within it
  int size = 1;   ///< in operations
};
[[nodiscard]] Text text_of(const Noted& noted, const std::vector<Text>& operands, const Names& names);

/// The number itself, to the last bit.
[[nodiscard]] std::string number_text(double value, bool single);
/// "double", "float"; "int" of a condition or a place.
[[nodiscard]] std::string type_of(const Noted& noted);
[[nodiscard]] bool is_whole(const Noted& noted);

}  // namespace kerf::traced
