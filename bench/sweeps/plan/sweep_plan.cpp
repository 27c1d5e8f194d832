#include "plan/sweep_plan.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "recordings/provenance.h"
#include "verbs/sweep_verb.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json value_json(const SweepValue& value) {
  if (const auto* const number = std::get_if<double>(&value)) return *number;
  return std::get<std::string>(value);
}

json values_json(const InputValues& values) {
  if (const auto& range = values.range())
    return {{"from", range->from},
            {"to", range->to},
            {"count", range->count},
            {"scale", range->logarithmic ? "logarithmic" : "linear"}};
  json list = json::array();
  for (const SweepValue& value : values.listed()) list.push_back(value_json(value));
  return list;
}

}  // namespace

std::size_t SweepCell::place_of(std::string_view input) const {
  const auto found = std::ranges::find(*inputs_, input, &SweepInput::name);
  if (found == inputs_->end()) throw std::logic_error(fmt::format("no input is called '{}'", input));
  return static_cast<std::size_t>(found - inputs_->begin());
}

const SweepValue& SweepCell::value(std::string_view input) const {
  const auto& value = values_[place_of(input)];
  if (!value) throw std::invalid_argument(fmt::format("'{}' is not given", input));
  return *value;
}

double SweepCell::number(std::string_view input) const { return std::get<double>(value(input)); }

const std::string& SweepCell::text(std::string_view input) const {
  return std::get<std::string>(value(input));
}

std::uint64_t SweepBlock::cells() const {
  std::uint64_t product = 1;
  for (const InputValues& values : inputs) {
    if (values.size() > 0 && __builtin_mul_overflow(product, values.size(), &product))
      return SweepPlan::most_cells + 1;
  }
  return product;
}

std::uint64_t SweepPlan::cells() const {
  std::uint64_t all = 0;
  for (const SweepBlock& block : blocks) all += std::min(block.cells(), most_cells + 1);
  return all;
}

SweepCell SweepPlan::cell(std::uint64_t number) const {
  SweepCell cell(inputs, number);
  std::uint64_t left = number;
  for (const SweepBlock& block : blocks) {
    const std::uint64_t here = block.cells();
    if (left >= here) {
      left -= here;
      continue;
    }
    for (std::size_t i = inputs.size(); i-- > 0;) {
      const InputValues& values = block.inputs[i];
      if (values.size() == 0) {
        if (inputs[i].standard) cell.set(i, *inputs[i].standard);
        continue;
      }
      cell.set(i, values.at(left % values.size()));
      left /= values.size();
    }
    return cell;
  }
  throw std::out_of_range(fmt::format("there is no cell {}", number));
}

std::string SweepPlan::name_of(const SweepCell& cell) const {
  std::map<std::string_view, std::string> named;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto& value = cell.values()[i];
    if (!value || value == inputs[i].standard) continue;
    named[inputs[i].name] =
        inputs[i].is_file() ? files.at(std::get<std::string>(*value)).sha256 : value_text(*value);
  }
  std::string text = fmt::format("kerf.cell 1\n{}\n", verb->name);
  for (const auto& [name, value] : named) text += fmt::format("{}={}\n", name, value);
  return sha256_of(std::string_view(text)).substr(0, 32);
}

json SweepPlan::as_json() const {
  json all_blocks = json::array();
  for (const SweepBlock& block : blocks) {
    json given = json::object();
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (block.inputs[i].size() > 0) given[inputs[i].name] = values_json(block.inputs[i]);
    all_blocks.push_back(std::move(given));
  }
  json all_files = json::object();
  for (const auto& [name, file] : files) all_files[name] = {{"bytes", file.bytes}, {"sha256", file.sha256}};
  return {{"verb", verb->name}, {"cells", all_blocks}, {"files", all_files}};
}

std::string SweepPlan::sha256() const { return sha256_of(std::string_view(as_json().dump())); }

ShardRange shard_range(std::uint64_t cells, std::uint64_t shard, std::uint64_t shards) {
  __extension__ using Wide = unsigned __int128;
  const auto begin_of = [&](std::uint64_t at) {
    return static_cast<std::uint64_t>(Wide{cells} * at / shards);
  };
  return {.begin = begin_of(shard), .end = begin_of(shard + 1)};
}

}  // namespace kerf::bench
