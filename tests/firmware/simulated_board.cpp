#include "simulated_board.h"

#include <stdexcept>
#include <utility>

extern "C" {
#include <simavr/avr_adc.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

namespace kerf::test {
namespace {

constexpr double cycles_per_s = 16e6;
constexpr std::uint64_t cycles_of_byte = 320;  // ten bits at 500,000 baud
constexpr std::uint32_t reference_mv = 5000;
// Data addresses of the ATmega328P.
constexpr std::size_t port_b = 0x25;
constexpr std::size_t port_d = 0x2B;
constexpr std::size_t timer_0_control = 0x44;
constexpr std::size_t timer_0_match_b = 0x48;

}  // namespace

SimulatedBoard::SimulatedBoard(const std::string& elf) : board_(avr_make_mcu_by_name("atmega328p")) {
  elf_firmware_t program{};
  if (board_ == nullptr || elf_read_firmware(elf.c_str(), &program) != 0)
    throw std::runtime_error(elf + ": no program of an ATmega328P that simavr can run");
  avr_init(board_);
  avr_load_firmware(board_, &program);
  board_->frequency = static_cast<std::uint32_t>(cycles_per_s);
  board_->vcc = board_->avcc = board_->aref = reference_mv;
  board_->log = LOG_ERROR;
  std::uint32_t flags = 0;
  avr_ioctl(board_, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
  flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO | AVR_UART_FLAG_POLL_SLEEP);
  avr_ioctl(board_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
  to_board_ = avr_io_getirq(board_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
  sensor_pin_ = avr_io_getirq(board_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC2);
  avr_irq_register_notify(avr_io_getirq(board_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_byte, this);
  avr_irq_register_notify(avr_io_getirq(board_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER), on_conversion,
                          this);
}

SimulatedBoard::~SimulatedBoard() { avr_terminate(board_); }

void SimulatedBoard::on_byte(avr_irq_t*, std::uint32_t value, void* board) {
  auto& self = *static_cast<SimulatedBoard*>(board);
  self.heard_.push_back({.at_s = self.now_s(), .byte = static_cast<std::uint8_t>(value)});
}

void SimulatedBoard::on_conversion(avr_irq_t*, std::uint32_t, void* board) {
  const auto& self = *static_cast<SimulatedBoard*>(board);
  // The middle of the count, rounded up, so that the converter's own rounding meets it.
  const auto count = static_cast<std::uint32_t>(self.sensor_);
  avr_raise_irq(self.sensor_pin_, (2 * count + 1) * reference_mv / 2047);
}

double SimulatedBoard::now_s() const noexcept { return static_cast<double>(board_->cycle) / cycles_per_s; }

void SimulatedBoard::run_until(double at_s) {
  while (now_s() < at_s) {
    if (!to_say_.empty() && board_->cycle >= free_at_) {
      avr_raise_irq(to_board_, to_say_.front());
      to_say_.pop_front();
      free_at_ = board_->cycle + cycles_of_byte;
    }
    const int state = avr_run(board_);
    if (state == cpu_Done || state == cpu_Crashed)
      throw std::runtime_error("the simulated board has crashed");
  }
}

void SimulatedBoard::say(std::span<const std::uint8_t> bytes) {
  to_say_.insert(to_say_.end(), bytes.begin(), bytes.end());
}

int SimulatedBoard::motor() const noexcept {
  const bool by_timer = (board_->data[timer_0_control] & 0x20U) != 0;  // COM0B1
  const int strength = by_timer                              ? board_->data[timer_0_match_b]
                       : (board_->data[port_d] & 0x20U) != 0 ? 255
                                                             : 0;
  return (board_->data[port_b] & 0x01U) != 0 ? -strength : strength;
}

std::vector<SimulatedBoard::Heard> SimulatedBoard::take_heard() { return std::exchange(heard_, {}); }

}  // namespace kerf::test
