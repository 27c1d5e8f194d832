#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

struct avr_t;
struct avr_irq_t;

namespace kerf::test {

/// An ATmega328P at 16 MHz with a program in it, by simavr, and what a Hapkit has at its pins: a sensor at
/// A2, the strength of the motor at pin 5, its direction at pin 8. Its line has 500,000 baud.
class SimulatedBoard {
 public:
  /// @throws std::runtime_error
  explicit SimulatedBoard(const std::string& elf);
  SimulatedBoard(const SimulatedBoard&) = delete;
  SimulatedBoard& operator=(const SimulatedBoard&) = delete;
  ~SimulatedBoard();

  struct Heard {
    double at_s;
    std::uint8_t byte;
  };

  /// So many seconds since it was switched on.
  void run_until(double at_s);
  /// After what waits already, byte by byte as the line takes.
  void say(std::span<const std::uint8_t> bytes);
  void set_sensor(int count) noexcept { sensor_ = count; }
  /// From -255 to 255, as motor and direction are told.
  [[nodiscard]] int motor() const noexcept;
  [[nodiscard]] double now_s() const noexcept;
  /// What it has said since the last time that this was asked.
  [[nodiscard]] std::vector<Heard> take_heard();

 private:
  static void on_byte(avr_irq_t* line, std::uint32_t value, void* board);
  static void on_conversion(avr_irq_t* line, std::uint32_t value, void* board);

  avr_t* board_;
  avr_irq_t* to_board_ = nullptr;
  avr_irq_t* sensor_pin_ = nullptr;
  int sensor_ = 512;
  std::deque<std::uint8_t> to_say_;
  std::uint64_t free_at_ = 0;  ///< cycle at which the line to the board is
  std::vector<Heard> heard_;
};

}  // namespace kerf::test
