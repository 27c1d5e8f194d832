#include "plan/plan_file.h"

#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "files/json_file.h"
#include "files/named_file.h"
#include "plan/planned_file.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr std::string_view format_of_plans = "kerf.sweep 1";

/// The same plan with the names of its files as from another folder.
SweepPlan moved_to(const SweepPlan& plan, const fs::path& folder) {
  if (plan.folder.lexically_normal() == folder.lexically_normal()) return plan;
  SweepPlan moved = plan;
  moved.folder = folder;
  const auto renamed = [&](const std::string& name) {
    return (plan.folder / name)
        .lexically_normal()
        .lexically_relative(folder.lexically_normal())
        .generic_string();
  };
  moved.files.clear();
  for (const auto& [name, file] : plan.files) moved.files[renamed(name)] = file;
  for (SweepBlock& block : moved.blocks) {
    for (std::size_t i = 0; i < moved.inputs.size(); ++i) {
      if (!moved.inputs[i].is_file() || block.inputs[i].size() == 0) continue;
      std::vector<SweepValue> values;
      for (const SweepValue& value : block.inputs[i].listed())
        values.emplace_back(renamed(std::get<std::string>(value)));
      block.inputs[i] = InputValues(std::move(values));
    }
  }
  return moved;
}

json cost_json(const ExpectedCost& cost, const SweepPlan& plan) {
  return {{"cells_timed", cost.timed},        {"cells_failed", cost.failed},
          {"seconds_a_cell", cost.cell_s},    {"longest_cell_seconds", cost.longest_s},
          {"seconds_to_begin", cost.begin_s}, {"seconds_in_all", cost.whole_s(plan.cells())},
          {"worker_bytes", cost.worker_bytes}};
}

InputValues values_from(const json& values) {
  if (values.is_object())
    return InputValues(InputValues::Range{.from = values.at("from").get<double>(),
                                          .to = values.at("to").get<double>(),
                                          .count = values.at("count").get<std::uint64_t>(),
                                          .logarithmic = values.at("scale") == "logarithmic"});
  std::vector<SweepValue> listed;
  for (const json& value : values) {
    if (value.is_string()) {
      listed.emplace_back(value.get<std::string>());
    } else {
      listed.emplace_back(value.get<double>());
    }
  }
  return InputValues(std::move(listed));
}

SweepBlock block_from(const json& given, const SweepPlan& plan) {
  SweepBlock block;
  std::size_t taken = 0;
  for (const SweepInput& input : plan.inputs) {
    const auto found = given.find(input.name);
    taken += found == given.end() ? 0 : 1;
    block.inputs.push_back(found == given.end() ? InputValues() : values_from(*found));
    if (input.required && block.inputs.back().size() == 0)
      throw std::invalid_argument(fmt::format("cells without '{}'", input.name));
  }
  if (taken != given.size()) throw std::invalid_argument("it varies what this version does not know");
  return block;
}

SweepPlan plan_from(const json& all, const fs::path& folder, SweepVerbs verbs) {
  SweepPlan plan = plan_from_json(all.at("plan"), folder, verbs);
  plan.shards = all.at("shards").get<std::uint64_t>();
  plan.limits = {.seconds = all.at("limits").at("seconds").get<double>(),
                 .megabytes = all.at("limits").at("megabytes").get<std::size_t>()};
  const std::uint64_t cells = plan.cells();
  if (cells < 1 || cells > SweepPlan::most_cells || plan.shards < 1 || !(plan.limits.seconds > 0.0))
    throw std::invalid_argument("numbers that no plan has");
  return plan;
}

}  // namespace

SweepPlan plan_from_json(const json& what, const fs::path& folder, SweepVerbs verbs) {
  SweepPlan plan;
  plan.folder = folder;
  plan.verb = &sweep_verb_called(what.at("verb").get<std::string>(), verbs);
  plan.inputs = plan.verb->inputs();
  for (const auto& [name, file] : what.at("files").items())
    plan.files[name] = {.bytes = file.at("bytes").get<std::uintmax_t>(),
                        .sha256 = file.at("sha256").get<std::string>()};
  for (const json& given : what.at("cells")) plan.blocks.push_back(block_from(given, plan));
  return plan;
}

fs::path PlanFile::shards_folder() const {
  std::string name = file.filename().string();
  if (name.ends_with(plan_ending)) name.resize(name.size() - plan_ending.size());
  return file.parent_path() / (name + ".shards");
}

void write_plan(const fs::path& file, const SweepPlan& plan, const std::optional<ExpectedCost>& cost,
                bool replace) {
  const SweepPlan here = moved_to(plan, fs::absolute(file).parent_path());
  json all{{"format", format_of_plans},
           {"sha256", here.sha256()},
           {"number_of_cells", here.cells()},
           {"shards", here.shards},
           {"limits", {{"seconds", here.limits.seconds}, {"megabytes", here.limits.megabytes}}},
           {"plan", here.as_json()}};
  if (cost) all["expected"] = cost_json(*cost, here);
  write_json_file(file, all, schema::existing_if(replace));
}

PlanFile read_plan(const fs::path& file, SweepVerbs verbs) {
  const std::string text = read_named_file(file, LargestInput::table);
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: {}; 'kerf sweep plan' writes plans", file.string(), why));
  };
  json all;
  try {
    all = json::parse(text);
  } catch (const json::exception&) {
    refuse("it is no plan of a sweep");
  }
  if (!all.is_object() || all.value("format", "") != format_of_plans)
    refuse(fmt::format("it is no plan of the format '{}'", format_of_plans));
  PlanFile read;
  try {
    read.file = fs::absolute(file).lexically_normal();
    read.plan = plan_from(all, read.file.parent_path(), verbs);
    read.sha256 = read.plan.sha256();
  } catch (const json::exception&) {
    refuse("it lacks what a plan has");
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  if (read.sha256 != all.value("sha256", ""))
    refuse("it was changed after it was written, its hash does not fit");
  return read;
}

void require_planned_files(const SweepPlan& plan, const ShardRange& range) {
  std::set<std::string> used;
  std::uint64_t first = 0;
  for (const SweepBlock& block : plan.blocks) {
    const std::uint64_t cells = block.cells();
    // Files change slowest, so that those of a part of a block are neighbours.
    if (first < range.end && first + cells > range.begin && block.inputs.front().size() > 0 &&
        plan.inputs.front().is_file()) {
      const std::uint64_t each = cells / block.inputs.front().size();
      const std::uint64_t begin = (std::max(range.begin, first) - first) / each;
      const std::uint64_t end = (std::min(range.end, first + cells) - first + each - 1) / each;
      for (std::uint64_t i = begin; i < end; ++i)
        used.insert(std::get<std::string>(block.inputs.front().at(i)));
    }
    first += cells;
  }
  for (const std::string& name : used) {
    const fs::path file = plan.folder / name;
    const PlannedFile& planned = plan.files.at(name);
    const SweepInput& input = plan.inputs.front();
    const bool same_size = NamedFile(file).size() == planned.bytes;
    if (same_size && planned_file(input, file).sha256 == planned.sha256) continue;
    throw std::invalid_argument(fmt::format(
        "{}: {} the file that was planned with; plan anew, or bring it back", file.string(),
        input.counts_with == nullptr || !same_size ? "it is not" : "it, or one that it names, is not"));
  }
}

}  // namespace kerf::bench
