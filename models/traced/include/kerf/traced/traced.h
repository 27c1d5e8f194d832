#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <kerf/models/parameter.h>

/// Laws written out as straight code, by running them on numbers that note down what is done with them.
namespace kerf::traced {

/// What was done with numbers. Of `number` and `place` the value stands in the node.
enum class Operation : std::uint8_t {
  number,  ///< of the law: a parameter, an option, what follows from them alone
  input,   ///< penetration, velocity, period: what a tick brings, by its place
  memory,  ///< what the state had, by its place
  plus,
  minus,
  times,
  divided,
  negative,
  less,
  less_or_equal,
  greater,
  greater_or_equal,
  equal,
  unequal,  ///< conditions
  chosen,   ///< of a condition, what it names
  rounded,  ///< to single precision
  widened,  ///< from single to double
  absolute,
  square_root,
  exponential,
  exponential_less_one,
  logarithm,
  logarithm_one_more,
  sine,
  cosine,
  tangent,
  arc_tangent,
  power,
  floor,
  place_of,    ///< a whole number as a place in a table
  segment_of,  ///< place of a segment between the numbers of a table
  entry        ///< what stands in a table at a place
};

/// A number, by its node in the trace that runs; below zero: of the law, with the value beside it.
using Node = std::int32_t;
inline constexpr Node of_the_law = -1;

/// What an operation makes of numbers that are not all of the law's. @param single of the result
Node note(Operation operation, bool single, std::array<Node, 3> of);
/// A number of the law as a node.
Node note_number(double value, bool single);
/// What the tick does where this condition decides its way.
bool decide(Node condition) noexcept;
/// The law cannot be written out, and why.
void refuse(const char* why) noexcept;
/// A table of numbers of the law, by its place.
Node note_table(std::vector<double> values, bool single);
Node note_entry(Node table, Node place, std::size_t further, bool single);

/// A condition on numbers.
struct Condition {
  bool value = false;  ///< if it is of the law
  Node node = of_the_law;
  // NOLINTNEXTLINE(google-explicit-constructor): as a bool, it says where the tick goes on
  operator bool() const noexcept { return node == of_the_law ? value : decide(node); }
};

/// A place in a table.
struct Place {
  Node node;
};

/// A number of this precision that notes down what is done with it. What depends on the law alone is reckoned
/// at once, as the law itself reckons it.
template <typename Real>
struct Traced {
  static constexpr bool single = std::is_same_v<Real, float>;

  Real value{};  ///< if it is of the law
  Node node = of_the_law;

  constexpr Traced() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a number is one of the law
  constexpr Traced(Real of_law) noexcept : value(of_law) {}
  template <typename Other>
  requires(!std::is_same_v<Other, Real>) explicit Traced(const Traced<Other>& other) noexcept
      : value(static_cast<Real>(other.value)),
        node(other.node == of_the_law
                 ? of_the_law
                 : note(single ? Operation::rounded : Operation::widened, single, {other.node, -1, -1})) {}
  template <typename Other>
  requires(std::is_arithmetic_v<Other> && !std::is_same_v<Other, Real> &&
           single) constexpr explicit Traced(Other of_law) noexcept
      : value(static_cast<Real>(of_law)) {}

  [[nodiscard]] bool of_law() const noexcept { return node == of_the_law; }
  [[nodiscard]] Node noted() const { return of_law() ? note_number(value, single) : node; }

  static Traced made(Operation operation, Real if_of_law, const Traced& a) {
    Traced result(if_of_law);
    if (!a.of_law()) result.node = note(operation, single, {a.node, -1, -1});
    return result;
  }
  static Traced made(Operation operation, Real if_of_law, const Traced& a, const Traced& b) {
    Traced result(if_of_law);
    if (!a.of_law() || !b.of_law()) result.node = note(operation, single, {a.noted(), b.noted(), -1});
    return result;
  }
  static Condition asked(Operation operation, bool if_of_law, const Traced& a, const Traced& b) {
    Condition result{.value = if_of_law};
    if (!a.of_law() || !b.of_law()) result.node = note(operation, single, {a.noted(), b.noted(), -1});
    return result;
  }

  friend Traced operator+(const Traced& a) { return a; }
  friend Traced operator-(const Traced& a) { return made(Operation::negative, -a.value, a); }
  friend Traced operator+(const Traced& a, const Traced& b) {
    return made(Operation::plus, a.value + b.value, a, b);
  }
  friend Traced operator-(const Traced& a, const Traced& b) {
    return made(Operation::minus, a.value - b.value, a, b);
  }
  friend Traced operator*(const Traced& a, const Traced& b) {
    return made(Operation::times, a.value * b.value, a, b);
  }
  friend Traced operator/(const Traced& a, const Traced& b) {
    return made(Operation::divided, a.value / b.value, a, b);
  }
  Traced& operator+=(const Traced& b) { return *this = *this + b; }
  Traced& operator-=(const Traced& b) { return *this = *this - b; }
  Traced& operator*=(const Traced& b) { return *this = *this * b; }

  friend Condition operator<(const Traced& a, const Traced& b) {
    return asked(Operation::less, a.value < b.value, a, b);
  }
  friend Condition operator<=(const Traced& a, const Traced& b) {
    return asked(Operation::less_or_equal, a.value <= b.value, a, b);
  }
  friend Condition operator>(const Traced& a, const Traced& b) {
    return asked(Operation::greater, a.value > b.value, a, b);
  }
  friend Condition operator>=(const Traced& a, const Traced& b) {
    return asked(Operation::greater_or_equal, a.value >= b.value, a, b);
  }
  friend Condition operator==(const Traced& a, const Traced& b) {
    return asked(Operation::equal, a.value == b.value, a, b);
  }
  friend Condition operator!=(const Traced& a, const Traced& b) {
    return asked(Operation::unequal, a.value != b.value, a, b);
  }

  friend Traced abs(const Traced& a) { return made(Operation::absolute, std::abs(a.value), a); }
  friend Traced sqrt(const Traced& a) { return made(Operation::square_root, std::sqrt(a.value), a); }
  friend Traced exp(const Traced& a) { return made(Operation::exponential, std::exp(a.value), a); }
  friend Traced expm1(const Traced& a) {
    return made(Operation::exponential_less_one, std::expm1(a.value), a);
  }
  friend Traced log(const Traced& a) { return made(Operation::logarithm, std::log(a.value), a); }
  friend Traced log1p(const Traced& a) { return made(Operation::logarithm_one_more, std::log1p(a.value), a); }
  friend Traced sin(const Traced& a) { return made(Operation::sine, std::sin(a.value), a); }
  friend Traced cos(const Traced& a) { return made(Operation::cosine, std::cos(a.value), a); }
  friend Traced tan(const Traced& a) { return made(Operation::tangent, std::tan(a.value), a); }
  friend Traced atan(const Traced& a) { return made(Operation::arc_tangent, std::atan(a.value), a); }
  friend Traced floor(const Traced& a) { return made(Operation::floor, std::floor(a.value), a); }
  friend Traced pow(const Traced& a, const Traced& b) {
    return made(Operation::power, std::pow(a.value, b.value), a, b);
  }

  // Those of kerf/models/choice.h.
  friend Traced chosen(const Condition& condition, const Traced& yes, const Traced& no) {
    if (condition.node == of_the_law) return condition.value ? yes : no;
    Traced result;
    result.node = note(Operation::chosen, single, {condition.node, yes.noted(), no.noted()});
    return result;
  }
  friend void let_go(Traced& number, const Traced& bound) {
    number = chosen(abs(number) < bound, Traced(), number);
  }
  friend Place place_of(const Traced& whole) {
    return {note(Operation::place_of, single, {whole.noted(), -1, -1})};
  }
  friend std::uint64_t count_of(const Traced&) noexcept {
    refuse(
        "forward Euler repeats its step as often as a tick had periods, which straight code cannot; take "
        "another "
        "integrator");
    return 1;
  }
};

/// The numbers of a table of the law.
template <typename Table>
Node table_of(const Table& table) {
  using Number = typename Table::value_type;
  std::vector<double> values;
  for (const Number& number : table) {
    if (!number.of_law()) refuse("a table of it changes from tick to tick");
    values.push_back(number.value);
  }
  return note_table(std::move(values), Number::single);
}
template <typename Table>
typename Table::value_type entry(const Table& table, const Place& place, std::size_t further = 0) {
  typename Table::value_type result;
  result.node = note_entry(table_of(table), place.node, further, Table::value_type::single);
  return result;
}
template <typename Real, std::size_t N>
Place segment_of(const std::array<Traced<Real>, N>& knot, std::size_t knots, const Traced<Real>& x) {
  const std::vector<Traced<Real>> used(knot.begin(), knot.begin() + static_cast<std::ptrdiff_t>(knots));
  return {note(Operation::segment_of, Traced<Real>::single, {table_of(used), x.noted(), -1})};
}

}  // namespace kerf::traced

template <typename Real>
struct kerf::models::Scalars<kerf::traced::Traced<Real>> {
  using Input = traced::Traced<Real>;
  using Signal = traced::Traced<double>;
  static constexpr bool single = std::is_same_v<Real, float>;
};
