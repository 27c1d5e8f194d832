#include "kerf/drivers/protocols/net_ft.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "kerf/drivers/protocols/serial_force.h"

namespace kerf::drivers::net_ft {
namespace {

constexpr std::uint16_t request_mark = 0x1234;
constexpr std::uint32_t latched_threshold = 0x80010000;
constexpr double most_counts = 1e12;  // a unit

std::uint32_t word_at(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return std::uint32_t{bytes[at]} << 24U | std::uint32_t{bytes[at + 1]} << 16U |
         std::uint32_t{bytes[at + 2]} << 8U | std::uint32_t{bytes[at + 3]};
}

struct Bit {
  unsigned number = 0;
  const char* words = "";
  bool overload = false;
};
/// Of the Net F/T. An Axia's differ; where both have a bit, the words are of both.
constexpr std::array<Bit, 28> ati_bits{{{30, "processor or memory, or an Axia out of its range"},
                                        {29, "digital board, or an Axia's calibration"},
                                        {28, "analog board, or an Axia's simulated error"},
                                        {27, "serial link, or an Axia's gauge out of its range"},
                                        {26, "program memory"},
                                        {25, "halted by configuration"},
                                        {24, "settings invalid"},
                                        {23, "configuration does not fit the calibration"},
                                        {22, "network"},
                                        {21, "CAN"},
                                        {20, "RDT"},
                                        {19, "EtherNet/IP"},
                                        {18, "DeviceNet"},
                                        {17, "transducer saturation or A/D", true},
                                        {16, "threshold latched"},
                                        {14, "watchdog"},
                                        {13, "stack"},
                                        {12, "EEPROM"},
                                        {11, "flash"},
                                        {10, "analog watchdog"},
                                        {9, "excitation too high"},
                                        {8, "excitation too low"},
                                        {7, "analog ground"},
                                        {6, "supply too high"},
                                        {5, "supply too low"},
                                        {4, "link data unavailable"},
                                        {3, "reference voltage"},
                                        {2, "temperature"}}};
struct Unit {
  std::string_view name;
  double si;
};
constexpr double pound_n = 4.4482216152605;
constexpr double inch_in_m = 0.0254;
constexpr double kilogram_force_n = 9.80665;
constexpr std::array<Unit, 6> force_names{{{"N", 1.0},
                                           {"lbf", pound_n},
                                           {"klbf", 1e3 * pound_n},
                                           {"kN", 1e3},
                                           {"kg", kilogram_force_n},
                                           {"gf", 1e-3 * kilogram_force_n}}};
/// Without the hyphen that some firmwares write.
constexpr std::array<Unit, 6> torque_names{{{"Nm", 1.0},
                                            {"Nmm", 1e-3},
                                            {"lbfin", pound_n* inch_in_m},
                                            {"lbfft", pound_n * 12.0 * inch_in_m},
                                            {"kgcm", kilogram_force_n * 0.01},
                                            {"kNm", 1e3}}};

template <std::size_t N>
std::optional<double> unit_in(const std::array<Unit, N>& all, std::string_view name) noexcept {
  const auto* found = std::ranges::find(all, name, &Unit::name);
  if (found == all.end()) return std::nullopt;
  return found->si;
}

std::optional<double> number_in(std::string_view text) noexcept {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = std::min(text.find_first_not_of(blanks), text.size());
  text.remove_prefix(first);
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// The elements of the page, one below its root each.
class Elements {
 public:
  explicit Elements(std::string_view xml) {
    const auto result = document_.load_buffer(xml.data(), xml.size(), pugi::parse_default);
    if (!result) throw std::invalid_argument("it is no XML");
    root_ = document_.document_element();
  }
  [[nodiscard]] std::optional<std::string> text(const char* name) const {
    const pugi::xml_node node = root_.child(name);
    if (!node) return std::nullopt;
    const std::string_view found = trimmed(node.child_value());
    if (found.empty()) return std::nullopt;
    return std::string(found);
  }
  [[nodiscard]] std::string required(const char* name) const {
    auto found = text(name);
    if (!found) throw std::invalid_argument(fmt::format("it has no <{}>", name));
    return std::move(*found);
  }
  /// Above zero.
  [[nodiscard]] double counts(const char* name) const {
    const std::string found = required(name);
    const auto value = number_in(found);
    if (!value || !(*value > 0.0) || *value > most_counts) {
      throw std::invalid_argument(
          fmt::format("<{}> is '{}', expected counts a unit, above zero", name, found));
    }
    return *value;
  }

 private:
  pugi::xml_document document_;
  pugi::xml_node root_;
};

}  // namespace

Request request(Command command, std::uint32_t count) noexcept {
  const auto code = static_cast<std::uint16_t>(command);
  const auto byte = [](std::uint32_t value, unsigned shift) {
    return static_cast<std::uint8_t>(value >> shift);
  };
  return {byte(request_mark, 8), byte(request_mark, 0), byte(code, 8),  byte(code, 0),
          byte(count, 24),       byte(count, 16),       byte(count, 8), byte(count, 0)};
}

std::optional<Record> parse_record(std::span<const std::uint8_t> bytes) noexcept {
  if (bytes.size() != record_size) return std::nullopt;
  Record record{
      .rdt_sequence = word_at(bytes, 0), .ft_sequence = word_at(bytes, 4), .status = word_at(bytes, 8)};
  for (std::size_t i = 0; i < record.counts.size(); ++i)
    record.counts[i] = static_cast<std::int32_t>(word_at(bytes, 12 + 4 * i));
  return record;
}

ForceHealth health_of(Box box, std::uint32_t status) noexcept {
  if (box == Box::onrobot) return optoforce::health_of(static_cast<std::uint16_t>(status));
  if (status == 0 || status == latched_threshold) return ForceHealth::sound;
  for (const Bit& bit : ati_bits) {
    if (bit.overload && (status >> bit.number & 1U) != 0) return ForceHealth::overload;
  }
  return ForceHealth::doubted;
}

std::string in_words(Box box, std::uint32_t status) {
  if (box == Box::onrobot) return optoforce::in_words(static_cast<std::uint16_t>(status));
  std::string all;
  const auto add = [&](std::string_view words) { all.append(all.empty() ? "" : ", ").append(words); };
  for (const Bit& bit : ati_bits) {
    if ((status >> bit.number & 1U) != 0) add(bit.words);
  }
  return all.empty() && status != 0 ? "unknown" : all;
}

std::optional<double> onrobot_corner_hz(std::uint64_t filter) noexcept {
  constexpr std::array<double, 7> corners{0.0, 500.0, 150.0, 50.0, 15.0, 5.0, 1.5};
  if (filter >= corners.size()) return std::nullopt;
  return corners[filter];
}

std::optional<double> force_unit_n(std::string_view name) noexcept { return unit_in(force_names, name); }

std::optional<double> torque_unit_n_m(std::string_view name) noexcept {
  std::string plain(name);
  std::erase(plain, '-');
  return unit_in(torque_names, plain);
}

Page parse_page(std::string_view xml) {
  const Elements elements(xml);
  Page page;
  page.product = elements.text("prodname").value_or("Net F/T");
  const std::string force = elements.required("scfgfu");
  const std::string torque = elements.required("scfgtu");
  const auto newtons = force_unit_n(force);
  const auto newton_metres = torque_unit_n_m(torque);
  if (!newtons)
    throw std::invalid_argument(fmt::format("its force is in '{}', a unit that is not known", force));
  if (!newton_metres)
    throw std::invalid_argument(fmt::format("its torque is in '{}', a unit that is not known", torque));
  page.counts_per_n = elements.counts("cfgcpf") / *newtons;
  page.counts_per_n_m = elements.counts("cfgcpt") / *newton_metres;
  // The second is how some firmwares write it.
  for (const char* name : {"comrdtrate", "commrdtrate"}) {
    if (const auto rate = elements.text(name)) page.rate_hz = number_in(*rate);
  }
  if (page.rate_hz && !(*page.rate_hz > 0.0)) page.rate_hz.reset();
  page.filter = elements.text("setuserfilter");
  page.bias = elements.text("setbias");
  page.tool = elements.text("cfgtfx");
  page.serial = elements.text("cfgcalsn");
  if (const auto enabled = elements.text("comrdte")) page.enabled = *enabled == "Enabled" || *enabled == "1";
  return page;
}

}  // namespace kerf::drivers::net_ft
