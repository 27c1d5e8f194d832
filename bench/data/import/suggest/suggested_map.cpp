#include "import/suggest/suggested_map.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "import/column_map.h"
#include "import/suggest/time_column.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

/// What a heading begins with, and the unit that is usual for it where the file says none.
struct KnownName {
  std::string_view word;
  std::string_view channel;
  std::string_view unit;
};

constexpr std::array known_names{
    KnownName{"time", "time", "s"},
    KnownName{"timestamp", "time", "s"},
    KnownName{"t", "time", "s"},
    KnownName{"zeit", "time", "s"},
    KnownName{"temps", "time", "s"},
    KnownName{"tiempo", "time", "s"},
    KnownName{"elapsed", "time", "s"},
    KnownName{"seconds", "time", "s"},
    KnownName{"position", "position", "mm"},
    KnownName{"pos", "position", "mm"},
    KnownName{"x", "position", "mm"},
    KnownName{"displacement", "position", "mm"},
    KnownName{"travel", "position", "mm"},
    KnownName{"depth", "position", "mm"},
    KnownName{"extension", "position", "mm"},
    KnownName{"weg", "position", "mm"},
    KnownName{"angle", "position", "deg"},
    KnownName{"theta", "position", "deg"},
    KnownName{"force", "force", "N"},
    KnownName{"load", "force", "N"},
    KnownName{"f", "force", "N"},
    KnownName{"fz", "force", "N"},
    KnownName{"kraft", "force", "N"},
    KnownName{"torque", "force", "Nm"},
};

/// The first word of a heading, in small letters.
std::string first_word(std::string_view heading) {
  std::string word;
  for (const char c : heading) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) break;
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return word;
}

const KnownName* known_name(const TextColumn& column) {
  const std::string word = first_word(column.name);
  const auto* const found = std::ranges::find(known_names, std::string_view(word), &KnownName::word);
  return found == known_names.end() ? nullptr : found;
}

class Suggestion {
 public:
  Suggestion(const TextLayout& layout, std::string_view text)
      : layout_(layout), text_(text), taken_(layout.columns.size(), false) {}

  std::string in_words() {
    const bool units_known =
        std::ranges::any_of(layout_.columns, [](const TextColumn& column) { return !column.unit.empty(); });
    const bool has_time = by_unit("time") || by_name("time") || by_ticking() ||
                          (!units_known && layout_.columns.size() > 2 && by_place("time", "s"));
    if (!by_unit("position") && !by_name("position")) by_place("position", "mm");
    if (!by_unit("force") && !by_name("force")) by_place("force", "N");
    return fmt::format("--map '{}'{}", fmt::join(entries_, ","), has_time ? "" : " --rate 100");
  }

 private:
  bool take(std::size_t column, std::string_view channel, std::string_view unit) {
    taken_[column] = true;
    entries_.push_back(fmt::format("{}={}[{}]", channel, column + 1, unit));
    return true;
  }

  bool by_unit(std::string_view channel) {
    const auto kinds = kinds_of(channel);
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const std::string& unit = layout_.columns[i].unit;
      if (taken_[i] || unit.empty()) continue;
      if (std::ranges::find(kinds, parse_unit(unit).si) != kinds.end()) return take(i, channel, unit);
    }
    return false;
  }

  /// A column whose unit says that it is another thing is none, whatever its name.
  bool by_name(std::string_view channel) {
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const KnownName* const known = known_name(layout_.columns[i]);
      if (taken_[i] || known == nullptr || known->channel != channel || !layout_.columns[i].unit.empty())
        continue;
      if (channel != "time") return take(i, channel, known->unit);
      const auto ticking = find_time_column(layout_, text_, {i});
      return take(i, channel, ticking ? usual_unit_of_time(ticking->step) : std::string(known->unit));
    }
    return false;
  }

  bool by_ticking() {
    if (layout_.columns.size() <= 2) return false;  // two may be a way and its force
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const TextColumn& column = layout_.columns[i];
      if (column.unit.empty() && known_name(column) == nullptr) open.push_back(i);
    }
    const auto found = find_time_column(layout_, text_, open);
    return found && take(found->index, "time", usual_unit_of_time(found->step));
  }

  /// The first column of which nothing is known, else the first one; of the time the former alone.
  bool by_place(std::string_view channel, std::string_view unit) {
    std::size_t first = taken_.size();
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (taken_[i]) continue;
      if (known_name(layout_.columns[i]) == nullptr) return take(i, channel, unit);
      first = std::min(first, i);
    }
    return channel != "time" && first < taken_.size() && take(first, channel, unit);
  }

  const TextLayout& layout_;
  std::string_view text_;
  std::vector<bool> taken_;
  std::vector<std::string> entries_;
};

}  // namespace

std::string suggest_map(const TextLayout& layout, std::string_view text) {
  return Suggestion(layout, text).in_words();
}

}  // namespace kerf::bench
