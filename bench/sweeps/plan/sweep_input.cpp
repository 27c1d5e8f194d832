#include "plan/sweep_input.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace kerf::bench {
namespace {

double rounded(double value) {
  const std::string text = fmt::format("{:.12g}", value);
  double back = value;
  (void)std::from_chars(text.data(), text.data() + text.size(), back);
  return back;
}

}  // namespace

std::string value_text(const SweepValue& value) {
  if (const auto* const number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  return std::get<std::string>(value);
}

std::string SweepInput::wrong_with(const SweepValue& value) const {
  if (std::holds_alternative<std::string>(value) != is_text())
    return is_text() ? "it takes a text" : "it takes a number";
  if (is_text()) {
    const auto& text = std::get<std::string>(value);
    if (among.empty() || std::ranges::find(among, text) != among.end()) return "";
    return fmt::format("'{}' is not one of {}", text, fmt::join(among, ", "));
  }
  const double number = std::get<double>(value);
  if (!(number >= lower && number <= upper))
    return fmt::format("{} is not within {} and {} {}", number, lower, upper, unit == "1" ? "" : unit);
  if (kind == Kind::whole && (number != std::floor(number) || std::abs(number) > 0x1p53))
    return fmt::format("{} is no whole number", number);
  return "";
}

SweepValue InputValues::at(std::uint64_t place) const {
  if (!range_) return listed_.at(place);
  if (place == 0) return range_->from;
  if (place + 1 == range_->count) return range_->to;
  const double share = static_cast<double>(place) / static_cast<double>(range_->count - 1);
  if (range_->logarithmic) return rounded(range_->from * std::pow(range_->to / range_->from, share));
  return rounded(range_->from + share * (range_->to - range_->from));
}

}  // namespace kerf::bench
