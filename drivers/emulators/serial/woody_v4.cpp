#include "serial/woody_v4.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <fmt/format.h>

namespace kerf::emulators {
namespace {

constexpr double usb_bits_per_s = 12e6;  // the rate of the port is not looked at
constexpr double watchdog_s = 0.1;
constexpr std::size_t longest_message = 127;
constexpr int most_current_ma = 6000;
constexpr double max_travel_m = 0.1;

/// hfabapi's flags (0, 1, 1) of a Woody: where one is set a counter falls as the angle grows, and a positive
/// current lowers the angle.
constexpr mechanisms::WoodenHaptics::Signs wiring{.encoder = {1.0, -1.0, -1.0}, .motor = {1.0, -1.0, -1.0}};

bool ends_a_message(char c) { return c == '\n' || c == '\r' || c == '\0'; }

/// Three whole numbers with commas between them; error 1024 for others, 512 for another count of commas.
int numbers_in(const std::string& text, std::array<int, 3>& numbers) {
  if (std::ranges::count(text, ',') != 2) return 512;
  std::istringstream cells(text);
  for (int& number : numbers) {
    std::string cell;
    std::getline(cells, cell, ',');
    std::istringstream one(cell);
    if (!(one >> number) || one.peek() != std::istringstream::traits_type::eof()) return 1024;
  }
  return 0;
}

}  // namespace

std::unique_ptr<EmulatedOnLine> EmulatedWoodyV4::make(drivers::UriOptions given, std::vector<Fault> faults) {
  const Options options = parse_common(given);
  Own own{.model = static_cast<int>(given.number("model", {"1", 3.0, 0.0, 100.0})),
          .answer_s = given.number("answer", {"s", 1e-4, 0.0, 1.0})};
  const double button_s = given.number("button", {"s", -1.0, -1.0, 1e6});
  if (button_s >= 0.0) own.button_s = button_s;
  own.counter_offset = static_cast<int>(given.number("counter_offset", {"1", 0.0, -1e6, 1e6}));
  given.refuse_others();
  return std::make_unique<EmulatedWoodyV4>(options, own, std::move(faults));
}

EmulatedWoodyV4::EmulatedWoodyV4(const Options& options, const Own& own, std::vector<Fault> faults)
    : EmulatedSerialDevice(
          options,
          {.centre_m = mechanisms::WoodenHaptics::find("woody-2016")->centre_m, .max_travel_m = max_travel_m},
          std::move(faults), usb_bits_per_s),
      own_(own),
      mechanism_(*mechanisms::WoodenHaptics::find("woody-2016"), wiring) {
  zero_.fill(-own.counter_offset);
  set_watchdog(watchdog_s);
}

std::array<int, 3> EmulatedWoodyV4::raw_counts() const {
  std::array<int, 3> counts{};
  if (const auto angles = mechanism_.angles_of(position())) {
    const auto exact = mechanism_.counts(*angles);
    std::ranges::transform(exact, counts.begin(),
                           [](double one) { return static_cast<int>(std::lround(one)); });
  }
  return counts;
}

Eigen::Vector3d EmulatedWoodyV4::force() const {
  const auto angles = mechanism_.angles_of(position());
  if (!angles) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d found =
      mechanism_.force({1e-3 * current_ma_[0], 1e-3 * current_ma_[1], 1e-3 * current_ma_[2]}, *angles);
  return found.allFinite() ? found : Eigen::Vector3d::Zero();
}

void EmulatedWoodyV4::moved() {
  adjust(force());
  if (own_.button_s && !was_pressed_ && world_s() >= *own_.button_s) {
    was_pressed_ = true;
    zero_ = raw_counts();
  }
}

void EmulatedWoodyV4::let_go_by_watchdog() { current_ma_ = {}; }

void EmulatedWoodyV4::begin_anew() {
  zero_ = raw_counts();
  told_ = current_ma_ = {};
  heard_.clear();
}

void EmulatedWoodyV4::hear(std::span<const std::uint8_t> bytes) {
  heard_.append(bytes.begin(), bytes.end());
  while (!heard_.empty()) {
    const auto begin = std::ranges::find_if_not(heard_, ends_a_message);
    heard_.erase(heard_.begin(), begin);
    const auto end = heard_.find(']');
    if (end == std::string::npos) {
      if (heard_.size() < longest_message) return;
      heard_.clear();
      answer(128);
      return;
    }
    const std::string message = heard_.substr(0, end);
    const bool has_more =
        !std::all_of(heard_.begin() + static_cast<std::ptrdiff_t>(end) + 1, heard_.end(), ends_a_message);
    heard_.clear();  // it reads what is waiting
    take_message(message, has_more);
  }
}

void EmulatedWoodyV4::take_message(std::string_view text, bool has_more) {
  const auto begin = text.find('[');
  if (begin == std::string_view::npos) return answer(256);
  std::array<int, 3> current_ma{};
  if (const int error = numbers_in(std::string(text.substr(begin + 1)), current_ma); error != 0)
    return answer(error);
  if (has_more) return answer(8);
  for (int& one : current_ma) one = std::abs(one) > most_current_ma ? 0 : one;
  feed_watchdog();
  current_ma_ = current_ma;
  push(force());
  const auto counts = raw_counts();
  for (std::size_t i = 0; i < told_.size(); ++i) told_.at(i) = counts.at(i) - zero_.at(i);
  answer(0);
}

void EmulatedWoodyV4::answer(int error) {
  const std::string text =
      fmt::format("[{},{},{},{},0,0,0,{}]\n", own_.model, told_[0], told_[1], told_[2], error);
  say({text.begin(), text.end()}, own_.answer_s);
}

}  // namespace kerf::emulators
