#include "c_text.h"

#include <array>
#include <charconv>
#include <cmath>

namespace kerf::traced {
namespace {

constexpr int atom = 9;
constexpr int prefix = 7;
constexpr int product = 6;
constexpr int sum = 5;
constexpr int order = 4;
constexpr int equality = 3;
constexpr int choice = 1;

std::string within(const Text& text, int least) {
  return text.binds < least ? "(" + text.text + ")" : text.text;
}

Text binary(const char* sign, int binds, const std::vector<Text>& of, int size) {
  // From left to right: what stands at the right in the same rank is another order of rounding.
  return {within(of[0], binds) + sign + within(of[1], binds + 1), binds, size};
}

/// a < b, with a number at the right where there is one.
Text compared(const char* sign, const char* turned, int binds, const Noted&, const std::vector<Text>& of,
              int size, bool first_is_number) {
  if (!first_is_number) return binary(sign, binds, of, size);
  return binary(turned, binds, {of[1], of[0]}, size);
}

const char* function_of(Operation operation) {
  switch (operation) {
    case Operation::absolute:
      return "fabs";
    case Operation::square_root:
      return "sqrt";
    case Operation::exponential:
      return "exp";
    case Operation::exponential_less_one:
      return "expm1";
    case Operation::logarithm:
      return "log";
    case Operation::logarithm_one_more:
      return "log1p";
    case Operation::sine:
      return "sin";
    case Operation::cosine:
      return "cos";
    case Operation::tangent:
      return "tan";
    case Operation::arc_tangent:
      return "atan";
    case Operation::floor:
      return "floor";
    case Operation::power:
      return "pow";
    default:
      return "";
  }
}

bool is_number(const Text& text) {
  return text.binds == atom && !text.text.empty() && text.text[0] >= '0' && text.text[0] <= '9';
}

}  // namespace

Names::Names(const Program& program, std::string_view law) : law_(law), has_ways_(program.ways.size() > 1) {
  for (const Memory& memory : program.memory) {
    for (std::size_t i = 0; i < memory.first.size(); ++i) {
      const std::string number = std::to_string(i);
      memory_.push_back("s->" + memory.name + (memory.is_array ? "[" + number + "]" : ""));
      plain_.push_back(memory.name + (memory.is_array ? "_" + number : ""));
    }
  }
  for (const auto& table : program.tables) table_sizes_.push_back(table.size());
}

std::string table_name(std::size_t table) { return "table_" + std::to_string(table + 1); }

std::string number_text(double value, bool single) {
  if (std::isinf(value)) return value > 0.0 ? "HUGE_VAL" : "(-HUGE_VAL)";
  std::array<char, 40> buffer{};
  char* const begin = buffer.data();
  const auto result = single ? std::to_chars(begin, begin + buffer.size(), static_cast<float>(value))
                             : std::to_chars(begin, begin + buffer.size(), value);
  std::string text(begin, result.ptr);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  if (single) text += "f";
  return text[0] == '-' ? "(" + text + ")" : text;
}

bool is_whole(const Noted& noted) {
  switch (noted.operation) {
    case Operation::less:
    case Operation::less_or_equal:
    case Operation::greater:
    case Operation::greater_or_equal:
    case Operation::equal:
    case Operation::unequal:
    case Operation::place_of:
    case Operation::segment_of:
      return true;
    default:
      return false;
  }
}

std::string type_of(const Noted& noted) {
  return is_whole(noted) ? "int" : noted.single ? "float" : "double";
}

Text text_of(const Noted& noted, const std::vector<Text>& of, const Names& names) {
  int size = 1;
  for (const Text& one : of) size += one.size;
  const auto compare = [&](const char* sign, const char* turned, int binds) {
    return compared(sign, turned, binds, noted, of, size, is_number(of[0]));
  };
  switch (noted.operation) {
    case Operation::number:
      return {.text = number_text(noted.number, noted.single)};
    case Operation::input:
      return {.text = noted.place == penetration ? "x" : noted.place == velocity ? "v" : "T"};
    case Operation::memory:
      return {.text = names.memory(static_cast<std::size_t>(noted.place))};
    case Operation::plus:
      return binary(" + ", sum, of, size);
    case Operation::minus:
      return binary(" - ", sum, of, size);
    case Operation::times:
      return binary(" * ", product, of, size);
    case Operation::divided:
      return binary(" / ", product, of, size);
    case Operation::negative:
      return {"(-" + within(of[0], prefix) + ")", atom, size};
    case Operation::less:
      return compare(" < ", " > ", order);
    case Operation::less_or_equal:
      return compare(" <= ", " >= ", order);
    case Operation::greater:
      return compare(" > ", " < ", order);
    case Operation::greater_or_equal:
      return compare(" >= ", " <= ", order);
    case Operation::equal:
      return binary(" == ", equality, of, size);
    case Operation::unequal:
      return binary(" != ", equality, of, size);
    case Operation::chosen:
      return {
          within(of[0], choice + 1) + " ? " + within(of[1], choice + 1) + " : " + within(of[2], choice + 1),
          choice, size};
    case Operation::rounded:
      return {"(float)" + within(of[0], prefix), prefix, size};
    case Operation::widened:
      return {"(double)" + within(of[0], prefix), prefix, size};
    case Operation::place_of:
      return {"(int)" + within(of[0], prefix), prefix, size};
    case Operation::segment_of: {
      const Node table = noted.of[0];
      return {"segment_of(" + table_name(static_cast<std::size_t>(table)) + ", " +
                  std::to_string(names.table_size(table)) + ", " + of[0].text + ")",
              atom, size};
    }
    case Operation::entry:
      return {table_name(static_cast<std::size_t>(noted.of[0])) + "[" + of[0].text +
                  (noted.place > 0 ? " + " + std::to_string(noted.place) : "") + "]",
              atom, size};
    default:
      break;
  }
  std::string text = function_of(noted.operation) + std::string(noted.single ? "f" : "") + "(";
  for (std::size_t i = 0; i < of.size(); ++i) text += (i == 0 ? "" : ", ") + of[i].text;
  return {text + ")", atom, size};
}

}  // namespace kerf::traced
