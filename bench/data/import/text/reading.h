#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// Texts in a line beside its numbers: fewer than those, as many, such as a date and a time of day, or any
/// number of them, below a line that names all columns.
enum class Texts { fewer, as_many, any };

/// One way to read the lines, and how well it reads them.
struct Reading {
  char separator;
  char point;
  std::size_t lines = 0;        ///< lines that are numbers in this reading
  std::size_t strangers = 0;    ///< fields in them that are no numbers
  std::size_t columns = 0;      ///< of the most of them
  Texts beside = Texts::fewer;  ///< how many texts a line of numbers may have

  [[nodiscard]] bool reads(std::string_view line) const;
};

/// The reading under which most of these lines are numbers, then the one with fewest other fields, then the
/// one with most columns. Lines of which half and more are texts are numbers where hardly any other is.
[[nodiscard]] Reading best_reading(const std::vector<std::string_view>& lines);

/// The place among `lines` at which the data begin: the first line of numbers, or, where a line of names
/// stands between that and those in the `middle`, which have as many fields as it, the first below the names.
/// The number of lines if there is none.
[[nodiscard]] std::size_t first_line_of_data(const Reading& reading,
                                             const std::vector<std::string_view>& lines,
                                             const std::vector<std::string_view>& middle);

}  // namespace kerf::bench
