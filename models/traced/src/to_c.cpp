#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "c_text.h"
#include "kerf/traced/program.h"

namespace kerf::traced {
namespace {

/// The numbers in memory that a force or a condition depends on, now or later: the others are books that a
/// law keeps beside it.
class Living {
 public:
  explicit Living(const Program& program) : program_(program) {
    std::size_t count = 0;
    for (const Memory& memory : program.memory) count += memory.first.size();
    living_.assign(count, false);
    std::size_t before = 0;
    do {
      before = number();
      for (const Way& way : program.ways) follow(way.tick);
    } while (number() != before);
  }
  [[nodiscard]] bool is(std::size_t place) const { return living_[place]; }
  /// Of a memory, up to the last that lives.
  [[nodiscard]] std::size_t length(const Memory& memory) const {
    std::size_t length = memory.first.size();
    while (length > 0 && !living_[memory.place + length - 1]) --length;
    return length;
  }

 private:
  [[nodiscard]] std::size_t number() const {
    return static_cast<std::size_t>(std::count(living_.begin(), living_.end(), true));
  }
  void follow(const Tick& tick) {
    if (tick.condition != of_the_law) {
      need(tick.condition);
      follow(*tick.yes);
      follow(*tick.no);
      return;
    }
    need(tick.outcome.force);
    for (std::size_t place = 0; place < living_.size(); ++place) {
      if (living_[place]) need(tick.outcome.next[place]);
    }
  }
  void need(Node node) {
    if (!seen_.insert(node).second) return;
    const Noted& noted = program_.nodes[static_cast<std::size_t>(node)];
    if (noted.operation == Operation::memory) living_[static_cast<std::size_t>(noted.place)] = true;
    for_each_operand(noted, [&](Node operand) { need(operand); });
  }

  const Program& program_;
  std::vector<bool> living_;
  std::set<Node> seen_;
};

/// One way of a tick as the body of a function.
class Body {
 public:
  Body(const Program& program, const Names& names, const Living& living, const Tick& tick)
      : program_(program), names_(names), living_(living), uses_(program.nodes.size(), 0) {
    count(tick);
    write(tick, 1);
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] bool takes(Input input) const { return inputs_.contains(input); }

 private:
  using Write = std::pair<std::size_t, Node>;

  void count(const Tick& tick) {
    if (tick.condition != of_the_law) {
      use(tick.condition);
      count(*tick.yes);
      count(*tick.no);
      return;
    }
    use(tick.outcome.force);
    for (const auto& [place, node] : writes(tick.outcome)) use(node);
  }
  void use(Node node) {
    if (uses_[static_cast<std::size_t>(node)]++ > 0) return;
    const Noted& noted = program_.nodes[static_cast<std::size_t>(node)];
    if (noted.operation == Operation::input) inputs_.insert(static_cast<Input>(noted.place));
    for_each_operand(noted, [&](Node operand) { use(operand); });
  }

  /// What of the memory becomes another number.
  [[nodiscard]] std::vector<Write> writes(const Outcome& outcome) const {
    std::vector<Write> all;
    for (std::size_t place = 0; place < outcome.next.size(); ++place) {
      if (!living_.is(place)) continue;
      const Noted& noted = program_.nodes[static_cast<std::size_t>(outcome.next[place])];
      const bool stays =
          noted.operation == Operation::memory && noted.place == static_cast<std::int32_t>(place);
      if (!stays) all.emplace_back(place, outcome.next[place]);
    }
    return all;
  }

  void line(int depth, const std::string& what) {
    text_ += std::string(static_cast<std::size_t>(2 * depth), ' ') + what + "\n";
  }

  void write(const Tick& tick, int depth) {
    const std::vector<Node> before = written_;
    if (tick.condition != of_the_law) {
      const std::string condition = expression(tick.condition, depth);
      line(depth, "if (" + condition + ") {");
      write(*tick.yes, depth + 1);
      line(depth, "}");
      write(*tick.no, depth);
    } else {
      finish(tick.outcome, depth);
    }
    for (const Node node : written_) {
      if (std::find(before.begin(), before.end(), node) == before.end()) names_of_.erase(node);
    }
    written_ = before;
  }

  /// All that is written is reckoned first: it depends on what was.
  void finish(const Outcome& outcome, int depth) {
    const std::vector<Write> all = writes(outcome);
    std::vector<std::string> values;
    for (const auto& [place, node] : all) {
      const std::string name = "next_" + names_.plain(place);
      values.push_back(all.size() > 1 ? kept(node, name, depth) : expression(node, depth));
    }
    const std::string force =
        all.empty() ? expression(outcome.force, depth) : kept(outcome.force, "force", depth);
    for (std::size_t i = 0; i < all.size(); ++i)
      line(depth, names_.memory(all[i].first) + " = " + values[i] + ";");
    if (names_.has_ways()) line(depth, "s->way = " + std::to_string(outcome.way) + ";");
    line(depth, "return " + force + ";");
  }
  /// The value of a node where the memory changes under it.
  std::string kept(Node node, const std::string& name, int depth) {
    const Text text = within(node, depth);
    const Operation operation = program_.nodes[static_cast<std::size_t>(node)].operation;
    if (operation == Operation::number || operation == Operation::input || names_of_.contains(node))
      return text.text;
    define(node, name, text.text, depth);
    return name;
  }

  /// The text of a node, after lines for what is used more than once, or is too long to stand within it.
  std::string expression(Node node, int depth) { return within(node, depth).text; }
  Text within(Node node, int depth) {
    if (const auto named = names_of_.find(node); named != names_of_.end()) return {.text = named->second};
    const Noted& noted = program_.nodes[static_cast<std::size_t>(node)];
    std::vector<Text> operands;
    for_each_operand(noted, [&](Node operand) { operands.push_back(within(operand, depth)); });
    Text text = text_of(noted, operands, names_);
    const bool by_itself = noted.operation == Operation::number || noted.operation == Operation::input ||
                           noted.operation == Operation::memory;
    if (by_itself || (uses_[static_cast<std::size_t>(node)] == 1 && text.size <= 8)) return text;
    const std::string name = (is_whole(noted) ? "i" : "t") + std::to_string(++named_);
    define(node, name, text.text, depth);
    return {.text = name};
  }
  void define(Node node, const std::string& name, const std::string& value, int depth) {
    const Noted& noted = program_.nodes[static_cast<std::size_t>(node)];
    line(depth, "const " + type_of(noted) + " " + name + " = " + value + ";");
    names_of_[node] = name;
    written_.push_back(node);
  }

  const Program& program_;
  const Names& names_;
  const Living& living_;
  std::vector<int> uses_;
  std::set<Input> inputs_;
  std::map<Node, std::string> names_of_;
  std::vector<Node> written_;
  int named_ = 0;
  std::string text_;
};

std::string state_of(const Program& program, const Names& names, const Living& living) {
  std::string text = "typedef struct " + names.law() + "_state {\n";
  std::string begin;
  for (const Memory& memory : program.memory) {
    for (std::size_t i = 0; i < memory.first.size(); ++i) {
      if (!living.is(memory.place + i)) continue;
      begin +=
          "  " + names.memory(memory.place + i) + " = " + number_text(memory.first[i], memory.single) + ";\n";
    }
    if (const std::size_t length = living.length(memory); length > 0)
      text += std::string("  ") + (memory.single ? "float " : "double ") + memory.name +
              (memory.is_array ? "[" + std::to_string(length) + "]" : "") + ";\n";
  }
  if (names.has_ways()) {
    text += "  int way; /* of the next tick, as it is numbered below */\n";
    begin += "  s->way = 0;\n";
  }
  if (begin.empty()) {
    text += "  char nothing; /* the force goes on from nothing */\n";
    begin = "  s->nothing = 0;\n";
  }
  text += "} " + names.law() + "_state;\n\n";
  return text + "static void " + names.law() + "_begin(" + names.law() + "_state* s) {\n" + begin + "}\n";
}

std::string tables_of(const Program& program) {
  std::string text;
  for (std::size_t i = 0; i < program.tables.size(); ++i) {
    const std::vector<double>& table = program.tables[i];
    text += "\nstatic const " + std::string(program.table_is_single[i] ? "float " : "double ") +
            table_name(i) + "[" + std::to_string(table.size()) + "] = {";
    std::string line = "\n   ";
    for (std::size_t k = 0; k < table.size(); ++k) {
      const std::string number =
          " " + number_text(table[k], program.table_is_single[i]) + (k + 1 < table.size() ? "," : "");
      if (line.size() + number.size() > 100) {
        text += line;
        line = "\n   ";
      }
      line += number;
    }
    text += line + "};\n";
  }
  return text;
}

/// For laws that look for a segment: of the numbers of a table, which grow.
std::string search_of(const Program& program) {
  std::set<bool> used;
  for (const Noted& noted : program.nodes) {
    if (noted.operation == Operation::segment_of) used.insert(noted.single);
  }
  std::string text;
  for (const bool single : used) {
    const std::string type = single ? "float" : "double";
    text +=
        "\n/* Place of the first of those segments that does not end before x; of none, the last. */\n"
        "static int segment_of(const " +
        type + "* knot, int knots, " + type +
        " x) {\n"
        "  int i = 0;\n  while (i + 2 < knots && knot[i + 1] < x) ++i;\n  return i;\n}\n";
  }
  return text;
}

}  // namespace

std::string to_c(const Program& program, std::string_view name) {
  const Names names(program, name);
  const Living living(program);
  std::string text = state_of(program, names, living) + tables_of(program) + search_of(program);
  std::string cases;
  for (std::size_t i = 0; i < program.ways.size(); ++i) {
    const Way& way = program.ways[i];
    const Body body(program, names, living, way.tick);
    std::string because;
    for (const auto& [mode, value] : way.because)
      because += (because.empty() ? "" : ", ") + mode + " = " + std::to_string(value);
    const std::string function = names.law() + "_way_" + std::to_string(i);
    std::string takes;
    std::string given;
    const auto take = [&](bool used, const std::string& type, const std::string& what) {
      if (!used) return;
      takes += (takes.empty() ? "" : ", ") + type + what;
      given += (given.empty() ? "" : ", ") + what;
    };
    take(body.text().find("s->") != std::string::npos, names.law() + "_state* ", "s");
    take(body.takes(penetration), "double ", "x");
    take(body.takes(velocity), "double ", "v");
    take(body.takes(period_s), "double ", "T");
    text += "\n" + (because.empty() ? "" : "/* " + because + " */\n") + "static " +
            (program.single ? "float " : "double ") + function + "(" + (takes.empty() ? "void" : takes) +
            ") {\n" + body.text() + "}\n";
    cases += "    case " + std::to_string(i) + ":\n      return " + function + "(" + given + ");\n";
  }
  const auto unused = [&](const char* what) { return std::string("  (void)") + what + ";\n"; };
  text +=
      "\n/* Force of a tick, positive where the tissue resists: penetration x, velocity v, time T since the "
      "last. */\n"
      "static double " +
      names.law() + "_resisting(" + names.law() + "_state* s, double x, double v, double T) {\n";
  text += unused("s") + unused("x") + unused("v") + unused("T");
  if (names.has_ways()) {
    // The last one is taken by a state that was written over, too: some force, and none out of bounds.
    const auto last = cases.rfind("    case ");
    const auto colon = cases.find(':', last);
    text += "  switch (s->way) {\n" + cases.replace(last, colon - last, "    default") + "  }\n";
  } else {
    text += cases.substr(cases.find("\n") + 5);
  }
  return text + "}\n";
}

}  // namespace kerf::traced
