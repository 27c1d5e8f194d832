#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// The text that a WoodenHaptics of the fourth generation (2022 on) speaks over its serial port: strictly one
/// message, one answer. Source: forsslund/woodenhaptics, firmware, and forsslund/hfabapi, host; facts of
/// both.
namespace kerf::drivers::woody_v4 {

/// Of a message, at least; the rest is zeros.
inline constexpr std::size_t least_size = 16;
/// Without a good message for longer the firmware cuts the current, and tells nobody.
inline constexpr std::int64_t watchdog_ns = 100'000'000;
/// A current above it is no current at all, on its axis alone [mA].
inline constexpr int most_current_ma = 6000;

/// "[mA,mA,mA]\n", zeros behind it. Currents are cut to what the firmware takes.
[[nodiscard]] std::string order(const std::array<int, 3>& current_ma);

/// What is behind which number in an answer.
enum class Model : std::uint8_t { polhem = 1, vintage_phantom = 2, woody = 3 };

struct Answer {
  int model = 0;
  std::array<int, 6> counter{};  ///< three of the motors, three of a gimbal
  int error = 0;                 ///< bits
};
/// Of "[model,e0,e1,e2,e3,e4,e5,error]"; nothing for another text.
[[nodiscard]] std::optional<Answer> parse(std::string_view text) noexcept;

/// The bits that say that the last message was not taken: its counters are those of the message before.
inline constexpr int not_taken = 8 | 128 | 256 | 512 | 1024;
/// What its bits say; empty for none.
[[nodiscard]] std::string in_words(int error);

/// Finds answers in what comes off the line, in pieces. What is longer than any answer is thrown away.
class AnswerReader {
 public:
  void add(std::string_view bytes);
  /// The next whole one, be it right or not, with its brackets; nothing if none has come to its end.
  [[nodiscard]] std::optional<std::string> next();
  void clear() noexcept { text_.clear(); }

 private:
  static constexpr std::size_t longest = 128;
  std::string text_;
};

}  // namespace kerf::drivers::woody_v4
