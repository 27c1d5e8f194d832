#include "import/suggest/suggested_map.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include "import/column_map.h"
#include "import/suggest/column_facts.h"
#include "import/suggest/stated_rate.h"
#include "import/suggest/time_column.h"
#include "import/text/unit_words.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

class Suggestion {
 public:
  Suggestion(const TextLayout& layout, std::string_view text)
      : layout_(layout), text_(text), facts_(facts_of(layout, text)), taken_(layout.columns.size(), false) {}

  SuggestedMap made() {
    const bool units_known =
        std::ranges::any_of(layout_.columns, [](const TextColumn& column) { return !column.unit.empty(); });
    const bool has_time = by_unit("time") || by_name("time") || by_ticking() ||
                          (!units_known && layout_.columns.size() > 2 && by_place("time", "s", 3));
    const bool has_position = by_unit("position") || by_name("position");
    const bool has_force = by_unit("force") || by_weight() || by_name("force");
    const std::size_t open = (has_position ? 0U : 1U) + (has_force ? 0U : 1U);
    if (!has_position && !by_place("position", "mm", open)) say_missing("position", "mm");
    if (!has_force && !by_place("force", "N", open)) say_missing("force", "N");
    for (const auto& entry : entries_) {
      if (!entry.empty()) suggested_.map += (suggested_.map.empty() ? "" : ",") + entry;
    }
    if (!guesses_.empty())
      suggested_.remarks.push_back(fmt::format(
          "the file says no unit where the map has {}: a guess, to be set right by who knows it", guesses_));
    if (!has_time) suggest_rate();
    return std::move(suggested_);
  }

 private:
  bool take(std::size_t column, std::string_view channel, std::string_view unit) {
    taken_[column] = true;
    const TextColumn& of = layout_.columns[column];
    if (of.stamps) {
      entry_of(channel) = fmt::format("{}={}", channel, column + 1);
      return true;
    }
    entry_of(channel) =
        fmt::format("{}={}[{}{}]", channel, column + 1, how_many_are_one(column, channel, unit), unit);
    return true;
  }

  /// What stands before a unit of which nobody but the lab knows how many of the file's numbers are one; says
  /// why, and where a unit is a guess.
  const char* how_many_are_one(std::size_t column, std::string_view channel, std::string_view unit) {
    const std::string& unknown = layout_.columns[column].unknown_unit;
    const auto say = [&](const std::string& what) { suggested_.remarks.push_back(what); };
    if (unit.starts_with('?') || is_raw_unit(unknown)) return unit.starts_with('?') ? "" : "counts/? ";
    if (!unknown.empty()) {
      say(has_factor(unknown)
              ? fmt::format(
                    "column {} is in {} as its heading says, a factor of which nobody can tell whether it "
                    "was applied: write for ? how many {} a 1 in the file is",
                    column + 1, unknown, unit)
              : fmt::format(
                    "column {} is in {}, which is no unit known here: write for ? how many {} one of it is",
                    column + 1, unknown, unit));
      return "? ";
    }
    if (!layout_.columns[column].unit.empty()) return "";
    if (facts_[column].are_whole && channel != "time") {
      say(fmt::format(
          "column {} has whole numbers of a thousand and more and no unit, as raw counts have: write "
          "for ? how many are one {}",
          column + 1, unit));
      return "counts/? ";
    }
    guesses_ += fmt::format("{}{} of column {}", guesses_.empty() ? "" : ", ", unit, column + 1);
    return "";
  }

  std::string& entry_of(std::string_view channel) {
    return entries_[channel == "time" ? 0 : channel == "position" ? 1 : 2];
  }

  [[nodiscard]] bool is_open(std::size_t column) const {
    const ColumnFacts& facts = facts_[column];
    return !taken_[column] && facts.holds_numbers && !facts.words.counts && !facts.words.is_other;
  }

  /// The first of those whose heading says most of what they are. Of moments that stand still another one.
  template <typename Fits>
  std::optional<std::size_t> best_of(std::string_view channel, const Fits& fits) const {
    std::optional<std::tuple<bool, Naming, std::size_t>> best;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const ColumnWords& words = facts_[i].words;
      if (!is_open(i) || !fits(i)) continue;
      const Naming naming = words.says(channel) ? words.naming : Naming::none;
      const std::tuple worth(facts_[i].is_coarse, channel == "time" ? Naming::none : naming, i);
      if (!best || worth < *best) best = worth;
    }
    return best ? std::optional(std::get<2>(*best)) : std::nullopt;
  }

  /// What its heading says is another thing is none, whatever its unit.
  [[nodiscard]] bool may_be(std::size_t column, std::string_view channel) const {
    const ColumnWords& words = facts_[column].words;
    return words.known == nullptr || words.known->word.size() == 1 || words.says(channel);
  }

  bool by_unit(std::string_view channel) {
    const auto kinds = kinds_of(channel);
    const auto found = best_of(channel, [&](std::size_t i) {
      const std::string& unit = layout_.columns[i].unit;
      return !unit.empty() && may_be(i, channel) &&
             std::ranges::find(kinds, parse_unit(unit).si) != kinds.end();
    });
    return found && take(*found, channel, layout_.columns[*found].unit);
  }

  /// A force that the file has as what it weighs.
  bool by_weight() {
    constexpr std::array weights{std::pair("g", "gf"), std::pair("kg", "kgf"), std::pair("mg", "0.001 gf"),
                                 std::pair("lb", "lbf"), std::pair("oz", "ozf")};
    const auto weight_of = [&](std::size_t i) -> const char* {
      const std::string& unit = layout_.columns[i].unit;
      if (unit.empty() || parse_unit(unit).si != "kg") return nullptr;
      const auto* const found = std::ranges::find_if(
          weights, [&](const auto& weight) { return parse_unit(weight.first) == parse_unit(unit); });
      return found == weights.end() ? nullptr : found->second;
    };
    const auto found = best_of(
        "force", [&](std::size_t i) { return facts_[i].words.says("force") && weight_of(i) != nullptr; });
    if (!found) return false;
    suggested_.remarks.push_back(fmt::format("column {} is in {}, a mass: what weighs that is a force in {}",
                                             *found + 1, layout_.columns[*found].unit, weight_of(*found)));
    return take(*found, "force", weight_of(*found));
  }

  /// A column whose unit says that it is another thing is none, whatever its name.
  bool by_name(std::string_view channel) {
    const auto found = best_of(channel, [&](std::size_t i) {
      return facts_[i].words.says(channel) && layout_.columns[i].unit.empty();
    });
    if (!found) return false;
    const std::string usual = usual_unit(*found);
    if (channel != "time") return take(*found, channel, usual);
    const auto ticking = find_time_column(layout_, text_, {*found});
    return take(*found, channel, ticking ? usual_unit_of_time(ticking->step) : usual);
  }

  /// ROS counts in m, N and N·m.
  [[nodiscard]] std::string usual_unit(std::size_t column) const {
    const std::string unit(facts_[column].words.known->unit);
    return unit == "mm" && layout_.columns[column].name.starts_with("field.") ? "m" : unit;
  }

  bool by_ticking() {
    if (layout_.columns.size() <= 2) return false;  // two may be a way and its force
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const TextColumn& column = layout_.columns[i];
      const bool are_rows = layout_.header_line > 0 && column.heading.empty();  // of R, and of "#"
      if (facts_[i].may_be_anything && column.unknown_unit.empty() && !are_rows) open.push_back(i);
    }
    const auto found = find_time_column(layout_, text_, open);
    return found && take(found->index, "time", usual_unit_of_time(found->step));
  }

  /// The first column of which nothing is known, if it has no heading, or no more have one than there are
  /// channels open.
  bool by_place(std::string_view channel, std::string_view unit, std::size_t channels) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (!taken_[i] && facts_[i].may_be_anything) open.push_back(i);
    }
    if (open.empty()) return false;
    const bool has_heading = !layout_.columns[open.front()].heading.empty();
    return (!has_heading || open.size() <= channels) && take(open.front(), channel, unit);
  }

  void say_missing(std::string_view channel, std::string_view unit) {
    suggested_.remarks.push_back(
        fmt::format("no column says that it is the {0}: add {0}=COLUMN[{1}]", channel, unit));
  }

  void suggest_rate() {
    const auto rate = stated_rate(text_.substr(0, std::min(layout_.data_begin, text_.size())));
    suggested_.rate = rate ? fmt::format("{:g}", *rate) : "HZ";
    const auto named = std::ranges::find_if(
        facts_, [](const ColumnFacts& facts) { return !facts.holds_numbers && facts.words.says("time"); });
    const std::string why =
        named == facts_.end()
            ? "no column says that it is the time"
            : fmt::format(
                  "column {} is the time by its name, but '{}' is neither a number nor a moment that is read",
                  named - facts_.begin() + 1, to_utf8(named->first_field));
    suggested_.remarks.push_back(
        rate ? fmt::format("{}: the lines before the data say --rate {}", why, suggested_.rate)
             : why + ": write for HZ how many rows are a second, or add time=COLUMN[s]");
  }

  const TextLayout& layout_;
  std::string_view text_;
  std::vector<ColumnFacts> facts_;
  std::vector<bool> taken_;
  std::array<std::string, 3> entries_;  // time, position, force
  std::string guesses_;                 // units that the file does not say
  SuggestedMap suggested_;
};

}  // namespace

std::string SuggestedMap::in_words() const {
  return fmt::format("--map '{}'{}", map, rate.empty() ? "" : " --rate " + rate);
}

SuggestedMap suggest_map(const TextLayout& layout, std::string_view text) {
  return Suggestion(layout, text).made();
}

}  // namespace kerf::bench
