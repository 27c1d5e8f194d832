#include "clocks/time_stamp.h"

#include <chrono>
#include <cstddef>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

constexpr std::int64_t ns_of_second = 1'000'000'000;
constexpr int first_year = 1950;
constexpr int last_year = 2149;

/// Takes a stamp off the front of a text, piece by piece.
class StampReader {
 public:
  StampReader(const char* begin, const char* end) : at_(begin), end_(end) {}

  [[nodiscard]] const char* at() const noexcept { return at_; }

  bool take(char expected) noexcept {
    if (at_ == end_ || *at_ != expected) return false;
    ++at_;
    return true;
  }

  /// A number of exactly so many digits; false, and nothing is taken, if there is none or it is beyond
  /// `most`.
  bool take_number(int digits, int most, int& number) noexcept {
    if (end_ - at_ < digits) return false;
    number = 0;
    for (int i = 0; i < digits; ++i) {
      if (at_[i] < '0' || at_[i] > '9') return false;
      number = 10 * number + (at_[i] - '0');
    }
    if (number > most) return false;
    at_ += digits;
    return true;
  }

  /// 2026-01-31 or 31.01.2026. Not 01/31/2026, which is a day of another month elsewhere.
  bool take_date(std::chrono::year_month_day& date) noexcept {
    int year = 0;
    int month = 0;
    int day = 0;
    const char* const begin = at_;
    const bool by_year = take_number(4, last_year, year) && take('-') && take_number(2, 12, month) &&
                         take('-') && take_number(2, 31, day);
    if (!by_year) {
      at_ = begin;
      if (!take_number(2, 31, day) || !take('.') || !take_number(2, 12, month) || !take('.') ||
          !take_number(4, last_year, year))
        return false;
    }
    date = {std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
            std::chrono::day(static_cast<unsigned>(day))};
    return year >= first_year && date.ok();
  }

  /// The digits of a fraction of a second.
  bool take_fraction(std::int64_t& ns) noexcept {
    constexpr int digits_of_ns = 9;
    int digits = 0;
    for (; at_ != end_ && *at_ >= '0' && *at_ <= '9'; ++at_, ++digits) {
      if (digits < digits_of_ns) ns = 10 * ns + (*at_ - '0');
      if (digits >= digits_of_ns && *at_ != '0') return false;
    }
    for (int i = digits; i < digits_of_ns; ++i) ns *= 10;
    return digits > 0;
  }

  /// Z or an offset; true also if there is none.
  bool take_zone(TimeStamp& stamp) noexcept {
    if (take('Z') || take('z')) {
      stamp.has_zone = true;
      return true;
    }
    if (at_ == end_ || (*at_ != '+' && *at_ != '-')) return true;
    const int sign = *at_++ == '+' ? 1 : -1;
    int hours = 0;
    int minutes = 0;
    if (!take_number(2, 23, hours)) return false;
    const bool colon = take(':');
    if (!take_number(2, 59, minutes)) {
      if (colon) return false;
      minutes = 0;
    }
    stamp.ns -= sign * (hours * 60LL + minutes) * 60 * ns_of_second;
    stamp.has_zone = true;
    return true;
  }

 private:
  const char* at_;
  const char* end_;
};

}  // namespace

const char* parse_time_stamp(const char* begin, const char* end, char separator, TimeStamp& stamp) noexcept {
  namespace chr = std::chrono;
  StampReader reader(begin, end);
  chr::year_month_day date{};
  int hour = 0;
  int minute = 0;
  int second = 0;
  if (!reader.take_date(date) ||
      !(reader.take('T') || reader.take('t') || (separator != ' ' && reader.take(' '))) ||
      !reader.take_number(2, 23, hour) || !reader.take(':') || !reader.take_number(2, 59, minute) ||
      !reader.take(':') || !reader.take_number(2, 59, second))
    return begin;
  std::int64_t ns = 0;
  if ((reader.take('.') || (separator != ',' && reader.take(','))) && !reader.take_fraction(ns)) return begin;
  const std::int64_t days = chr::sys_days(date).time_since_epoch().count();
  stamp = {.ns = (((days * 24 + hour) * 60 + minute) * 60 + second) * ns_of_second + ns, .has_zone = false};
  return reader.take_zone(stamp) ? reader.at() : begin;
}

bool is_time_stamp(std::string_view field, TimeStamp& stamp) noexcept {
  const char* const end = field.data() + field.size();
  return !field.empty() && parse_time_stamp(field.data(), end, '\0', stamp) == end;
}

std::string time_stamp_text(const TimeStamp& stamp) {
  namespace chr = std::chrono;
  const chr::sys_time<chr::nanoseconds> moment{chr::nanoseconds(stamp.ns)};
  const auto day = chr::floor<chr::days>(moment);
  const chr::year_month_day date(day);
  const chr::hh_mm_ss time(moment - day);
  std::string text = fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}", static_cast<int>(date.year()),
                                 static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                                 time.hours().count(), time.minutes().count(), time.seconds().count());
  if (const auto ns = time.subseconds().count(); ns != 0) {
    text += fmt::format(".{:09}", ns);
    while (text.back() == '0') text.pop_back();
  }
  return stamp.has_zone ? text + 'Z' : text;
}

std::string start_text(const schema::Header& header) {
  if (!header.start_ns) return {};
  if (header.start_clock == "UTC") return time_stamp_text({.ns = *header.start_ns, .has_zone = true});
  return time_stamp_text({.ns = *header.start_ns}) + " by a local clock, its zone unknown";
}

}  // namespace kerf::bench
