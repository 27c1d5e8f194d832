#include "trace.h"

#include <bit>
#include <stdexcept>
#include <utility>

namespace kerf::traced {
namespace {

thread_local Trace* the_trace = nullptr;

/// A law that takes more ways than this would make a file that nobody compiles.
constexpr std::size_t most_ways = 4096;

std::size_t hash_of(const Noted& noted) noexcept {
  std::size_t hash = static_cast<std::size_t>(noted.operation) * 2 + (noted.single ? 1 : 0);
  const auto mix = [&](std::size_t more) { hash = (hash ^ more) * 0x9e3779b97f4a7c15U + (hash >> 29U); };
  for (const Node node : noted.of) mix(static_cast<std::size_t>(node) + 7);
  mix(static_cast<std::size_t>(noted.place));
  mix(std::bit_cast<std::uint64_t>(noted.number));
  return hash;
}

/// a > b is b < a: one condition and not two.
Noted turned(Noted noted) noexcept {
  if (noted.operation == Operation::greater || noted.operation == Operation::greater_or_equal) {
    noted.operation = noted.operation == Operation::greater ? Operation::less : Operation::less_or_equal;
    std::swap(noted.of[0], noted.of[1]);
  }
  return noted;
}

bool same(const Noted& a, const Noted& b) noexcept {
  // 0 and -0 are two numbers.
  return a == b && std::bit_cast<std::uint64_t>(a.number) == std::bit_cast<std::uint64_t>(b.number);
}

}  // namespace

Trace::Trace() { the_trace = this; }
Trace::~Trace() { the_trace = nullptr; }
Trace& Trace::running() noexcept { return *the_trace; }

Node Trace::add(Noted noted) {
  noted = turned(noted);
  std::vector<Node>& alike = by_hash_[hash_of(noted)];
  for (const Node node : alike) {
    if (same(program.nodes[static_cast<std::size_t>(node)], noted)) return node;
  }
  const auto node = static_cast<Node>(program.nodes.size());
  program.nodes.push_back(noted);
  alike.push_back(node);
  return node;
}

Node Trace::add_table(std::vector<double> values, bool single) {
  for (std::size_t i = 0; i < program.tables.size(); ++i) {
    if (program.tables[i] == values && program.table_is_single[i] == single) return static_cast<Node>(i);
  }
  program.tables.push_back(std::move(values));
  program.table_is_single.push_back(single);
  return static_cast<Node>(program.tables.size() - 1);
}

void Trace::refuse(const char* why) noexcept {
  if (refusal_.empty()) refusal_ = why;
}

void Trace::know(Node condition, bool answer) {
  known_[condition] = answer;
  const Noted noted = program.nodes[static_cast<std::size_t>(condition)];
  if (!answer || (noted.operation != Operation::less && noted.operation != Operation::equal)) return;
  // What is less is not the other way round; of what is not less nothing follows, for it may be no number.
  const auto follows = [&](Operation operation, Node a, Node b, bool what) {
    Noted other = noted;
    other.operation = operation;
    other.of = {a, b, -1};
    known_[add(other)] = what;
  };
  const auto [a, b, none] = noted.of;
  const bool less = noted.operation == Operation::less;
  follows(Operation::less_or_equal, a, b, true);
  follows(Operation::less_or_equal, b, a, !less);
  follows(Operation::less, b, a, false);
  if (less) {
    follows(Operation::equal, a, b, false);
    follows(Operation::unequal, a, b, true);
  } else {
    follows(Operation::less, a, b, false);
    follows(Operation::unequal, a, b, false);
  }
}

bool Trace::decide(Node condition) noexcept {
  if (const auto known = known_.find(condition); known != known_.end()) return known->second;
  if (met_.size() == answers_.size()) answers_.push_back(true);
  const bool answer = answers_[met_.size()];
  met_.push_back(condition);
  know(condition, answer);
  return answer;
}

void Trace::begin_run() {
  met_.clear();
  known_.clear();
  if (++runs_ > most_ways) throw std::invalid_argument("it takes too many ways to be written out");
}

void Trace::end_run(Tick& tick, Outcome outcome) {
  if (!refusal_.empty()) throw std::invalid_argument(refusal_);
  Tick* at = &tick;
  for (std::size_t i = 0; i < met_.size(); ++i) {
    if (at->condition == of_the_law) {
      at->condition = met_[i];
      at->yes = std::make_unique<Tick>();
      at->no = std::make_unique<Tick>();
    }
    at = answers_[i] ? at->yes.get() : at->no.get();
  }
  at->outcome = std::move(outcome);
}

bool Trace::next_answers() {
  while (!answers_.empty() && !answers_.back()) answers_.pop_back();
  if (answers_.empty()) return false;
  answers_.back() = false;
  return true;
}

Node note(Operation operation, bool single, std::array<Node, 3> of) {
  return Trace::running().add({.operation = operation, .single = single, .of = of});
}
Node note_number(double value, bool single) {
  return Trace::running().add({.operation = Operation::number, .single = single, .number = value});
}
bool decide(Node condition) noexcept { return Trace::running().decide(condition); }
void refuse(const char* why) noexcept { Trace::running().refuse(why); }
Node note_table(std::vector<double> values, bool single) {
  return Trace::running().add_table(std::move(values), single);
}
Node note_entry(Node table, Node place, std::size_t further, bool single) {
  return Trace::running().add({.operation = Operation::entry,
                               .single = single,
                               .of = {table, place, -1},
                               .place = static_cast<std::int32_t>(further)});
}

}  // namespace kerf::traced
