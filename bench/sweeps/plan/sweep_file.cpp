#include "plan/sweep_file.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "files/named_file.h"
#include "fits/batch.h"
#include "laws/law_toml.h"
#include "plan/planned_file.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t most_shards = 1'000'000;

SweepValue value_of(const Place& place, const toml::node& node, const SweepInput& input) {
  SweepValue value;
  if (const auto text = node.value_exact<std::string>()) {
    value = *text;
  } else if (node.is_number()) {
    value = place.number(node, input.name);
  } else {
    place.refuse(node, "'{}' is neither a number nor a text", input.name);
  }
  if (const std::string wrong = input.wrong_with(value); !wrong.empty())
    place.refuse(node, "'{}': {}", input.name, wrong);
  return value;
}

/// A file by the name that the plan has it under; a folder stands for all recordings in it.
void add_files(const Place& place, const toml::node& node, const SweepInput& input, const std::string& name,
               SweepPlan& plan, std::vector<SweepValue>& values) {
  std::vector<fs::path> found{plan.folder / name};
  try {
    if (input.kind == SweepInput::Kind::recording && fs::is_directory(found.front()))
      found = recordings_in(found.front());
    for (const fs::path& file : found) {
      const std::string known = file.lexically_relative(plan.folder).generic_string();
      values.emplace_back(known);
      if (!plan.files.contains(known)) plan.files[known] = planned_file(input, file);
    }
  } catch (const std::invalid_argument& error) {
    place.refuse(node, "{}", error.what());
  }
}

/// `{ from = 1, to = 100 }`, with a `count` unless the numbers are whole, and `scale = "logarithmic"`.
InputValues range_of(const Place& place, const toml::table& table, const SweepInput& input) {
  place.allow_only(table, {"from", "to", "count", "scale"}, "a range");
  const auto end = [&](const char* key) {
    const toml::node* const node = table.get(key);
    if (node == nullptr) place.refuse(table, "a range needs '{}'", key);
    return std::get<double>(value_of(place, *node, input));
  };
  InputValues::Range range{.from = end("from"), .to = end("to")};
  const std::string scale = place.text(table, "scale", "linear");
  range.logarithmic = scale == "logarithmic";
  if (!range.logarithmic && scale != "linear")
    place.refuse(*table.get("scale"), "'scale' is \"linear\" or \"logarithmic\", not \"{}\"", scale);
  if (range.logarithmic && !(range.from > 0.0 && range.to > 0.0))
    place.refuse(table, "'{}': a logarithmic range needs ends greater than 0", input.name);
  const toml::node* const count = table.get("count");
  const bool whole = input.kind == SweepInput::Kind::whole;
  if (whole && (count != nullptr || range.logarithmic))
    place.refuse(table, "'{}': a range of whole numbers takes every one from 'from' to 'to'", input.name);
  if (whole) {
    if (range.to < range.from) place.refuse(table, "'{}': 'to' is less than 'from'", input.name);
    range.count = static_cast<std::uint64_t>(range.to - range.from) + 1;
  } else {
    const auto number = count == nullptr ? std::nullopt : count->value_exact<std::int64_t>();
    if (!number || *number < 2) place.refuse(table, "'{}': a range needs a 'count' from 2", input.name);
    range.count = static_cast<std::uint64_t>(*number);
  }
  return InputValues(range);
}

InputValues values_of(const Place& place, const toml::node& node, const SweepInput& input, SweepPlan& plan) {
  if (node.is_table()) {
    if (input.is_text()) place.refuse(node, "'{}': a range is of numbers", input.name);
    return range_of(place, *node.as_table(), input);
  }
  std::vector<SweepValue> values;
  const auto add = [&](const toml::node& one) {
    const SweepValue value = value_of(place, one, input);
    if (input.is_file()) {
      add_files(place, one, input, std::get<std::string>(value), plan, values);
    } else {
      values.push_back(value);
    }
  };
  if (const toml::array* const list = node.as_array()) {
    if (list->empty()) place.refuse(node, "'{}': the list is empty", input.name);
    for (const auto& one : *list) add(one);
  } else {
    add(node);
  }
  return InputValues(std::move(values));
}

SweepBlock block_of(const Place& place, const toml::table& table, SweepPlan& plan) {
  std::vector<std::string_view> names;
  for (const SweepInput& input : plan.inputs) names.push_back(input.name);
  place.allow_only(table, names, fmt::format("the cells of '{}'", plan.verb->name));
  SweepBlock block;
  for (const SweepInput& input : plan.inputs) {
    const toml::node* const node = table.get(input.name);
    if (node == nullptr && input.required)
      place.refuse(table, "cells of '{}' need '{}': {}", plan.verb->name, input.name, input.what);
    block.inputs.push_back(node == nullptr ? InputValues() : values_of(place, *node, input, plan));
  }
  return block;
}

void read_blocks(const Place& place, const toml::table& root, SweepPlan& plan) {
  const toml::node* const cells = root.get("cells");
  if (cells == nullptr)
    place.refuse(root, "a sweep needs [cells], or [[cells]] for each of several products");
  if (const toml::table* const one = cells->as_table()) {
    plan.blocks.push_back(block_of(place, *one, plan));
  } else if (const toml::array* const several = cells->as_array()) {
    for (const auto& node : *several) {
      if (!node.is_table()) place.refuse(node, "expected [[cells]] for each product");
      plan.blocks.push_back(block_of(place, *node.as_table(), plan));
    }
  }
  if (plan.blocks.empty())
    place.refuse(*cells, "expected [cells], or [[cells]] for each of several products");
  if (plan.cells() > SweepPlan::most_cells)
    place.refuse(*cells, "more than {} cells are no sweep; vary less", SweepPlan::most_cells);
}

void read_limits(const Place& place, const toml::table& root, SweepLimits& limits) {
  if (root.get("limits") == nullptr) return;
  const toml::table& table = place.table(root, "limits");
  place.allow_only(table, {"seconds", "megabytes"}, "[limits]");
  if (const toml::node* const seconds = table.get("seconds")) {
    limits.seconds = place.number(*seconds, "seconds");
    if (!(limits.seconds > 0.0)) place.refuse(*seconds, "'seconds' must be greater than 0");
  }
  if (const toml::node* const megabytes = table.get("megabytes")) {
    const auto number = megabytes->value_exact<std::int64_t>().value_or(0);
    if (number < 50) place.refuse(*megabytes, "'megabytes' is a whole number from 50");
    limits.megabytes = static_cast<std::size_t>(number);
  }
}

}  // namespace

SweepPlan read_sweep(const fs::path& file, SweepVerbs verbs) {
  const toml::table root = parse_toml(read_named_file(file), file.string());
  const Place place(file.string());
  const toml::node* const version = root.get("version");
  if (version == nullptr || version->value<int>() != 1) place.refuse(root, "expected version = 1 of a sweep");
  place.allow_only(root, {"version", "verb", "shards", "limits", "cells"}, "a sweep");
  SweepPlan plan;
  plan.folder = fs::absolute(file).parent_path();
  const toml::node* const verb = root.get("verb");
  if (verb == nullptr) place.refuse(root, "a sweep needs 'verb', such as verb = \"fit\"");
  try {
    plan.verb = &sweep_verb_called(place.text(root, "verb", ""), verbs);
  } catch (const std::invalid_argument& error) {
    place.refuse(*verb, "{}", error.what());
  }
  plan.inputs = plan.verb->inputs();
  plan.shards = 0;
  if (const toml::node* const shards = root.get("shards")) {
    const auto number = shards->value_exact<std::int64_t>().value_or(0);
    if (number < 1 || static_cast<std::uint64_t>(number) > most_shards)
      place.refuse(*shards, "'shards' is a whole number from 1 to {}", most_shards);
    plan.shards = static_cast<std::uint64_t>(number);
  }
  read_limits(place, root, plan.limits);
  read_blocks(place, root, plan);
  return plan;
}

}  // namespace kerf::bench
