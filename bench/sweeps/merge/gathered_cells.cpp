#include "merge/gathered_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <fmt/format.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

bool is_shard(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.ends_with(".shard") || name.ends_with(".shard.partial");
}

void add_shards_in(const fs::path& folder, std::vector<fs::path>& found) {
  std::error_code gone;
  for (const auto& entry : fs::directory_iterator(folder, gone)) {
    const std::string name = entry.path().filename().string();
    const bool numbered = std::ranges::all_of(name, [](char c) { return c >= '0' && c <= '9'; });
    if (is_shard(entry.path())) found.push_back(entry.path());
    if (numbered && entry.is_directory(gone)) add_shards_in(entry.path(), found);
  }
}

/// The text that is told of two equal failures, whichever was first.
auto order_of(const FailedCell& failed) { return std::tuple(failed.failure, failed.why); }

}  // namespace

std::vector<fs::path> shard_files_in(const fs::path& folder) {
  require_named_folder(folder);
  std::vector<fs::path> found;
  add_shards_in(folder, found);
  std::ranges::sort(found);
  return found;
}

std::string as_ranges(const std::vector<std::uint64_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", numbers[i]);
    if (end > i + 1) text += fmt::format("-{}", numbers[end - 1]);
    i = end;
  }
  return text;
}

GatheredCells::Bytes::Bytes(const fs::path& file, bool complete) {
  if (complete) {
    mapped_ = std::make_unique<MappedFile>(file);
  } else {
    read_ = read_named_file(file, std::numeric_limits<std::uintmax_t>::max());
  }
}

GatheredCells::GatheredCells(const PlanFile& plan, const fs::path& folder) : places_(plan.plan.cells()) {
  for (const fs::path& file : shard_files_in(folder)) take(plan, {.file = file});
}

void GatheredCells::take(const PlanFile& plan, FoundShard shard) {
  const auto number = static_cast<std::uint32_t>(files_.size());
  shard.complete = shard.file.extension() == ".shard";
  files_.emplace_back(shard.file, shard.complete);
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(fmt::format("{}: {}", shard.file.string(), why));
  };
  shard.content =
      read_shard(files_.back().text(), shard.file, [&](const CellRecord& record, std::uintmax_t at) {
        if (const auto* const layout = std::get_if<LayoutRecord>(&record)) {
          layouts_.try_emplace(layout->layout, CellLayout::from_text(layout->text));
          return;
        }
        const auto* const computed = std::get_if<ComputedCell>(&record);
        const std::uint64_t cell = computed != nullptr ? computed->cell : std::get<FailedCell>(record).cell;
        if (cell >= places_.size()) refuse(fmt::format("it has cell {}, which the plan does not", cell));
        if (computed != nullptr) {
          const auto layout = layouts_.find(computed->layout);
          if (layout == layouts_.end() ||
              layout->second.columns.size() * sizeof(double) != computed->numbers.size())
            refuse(fmt::format("cell {} has numbers of which it is not said what they are", cell));
        }
        ++(computed != nullptr ? shard.computed : shard.failed);
        take_cell(cell, {.at = at, .file = number, .computed = computed != nullptr}, record);
      });
  if (shard.content.whole_bytes == 0) return;  // a run that has just begun it
  if (shard.content.plan_sha256 != plan.sha256)
    refuse(fmt::format("it is of another plan ({}), and this one is {}",
                       shard.content.plan_sha256.substr(0, 12), plan.sha256.substr(0, 12)));
  if (shard.complete && shard.content.whole_bytes != shard.content.bytes)
    refuse("it is damaged; remove the file and compute the shard again");
  software_.insert(shard.content.software);
  fs::path place = shard.file;
  if (!shard.complete) place.replace_extension();
  shard.holder = ShardLock::holder_of(place);
  shards_.push_back(std::move(shard));
}

void GatheredCells::take_cell(std::uint64_t cell, const RecordPlace& place, const CellRecord& record) {
  RecordPlace& now = places_[cell];
  if (now.file == nowhere) {
    ++(place.computed ? computed_ : failed_);
    now = place;
    return;
  }
  if (now.computed && !place.computed) return;
  if (!now.computed && place.computed) {
    ++computed_;
    --failed_;
    now = place;
    return;
  }
  const CellRecord before = record_at(now);
  if (place.computed) {
    const ComputedCell& one = std::get<ComputedCell>(before);
    const ComputedCell& other = std::get<ComputedCell>(record);
    if (one.layout == other.layout && one.numbers == other.numbers) return;
    note_difference(cell, one, other);
    if (std::tie(other.layout, other.numbers) < std::tie(one.layout, one.numbers)) now = place;
  } else if (order_of(std::get<FailedCell>(record)) < order_of(std::get<FailedCell>(before))) {
    now = place;
  }
}

void GatheredCells::note_difference(std::uint64_t cell, const ComputedCell& one, const ComputedCell& other) {
  different_.insert(cell);
  const std::vector<double> first = one.values();
  const std::vector<double> second = other.values();
  if (one.layout != other.layout) largest_difference_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) {
    if (first[i] == second[i] || (std::isnan(first[i]) && std::isnan(second[i]))) continue;
    const double share = std::abs(first[i] - second[i]) / std::max(std::abs(first[i]), std::abs(second[i]));
    largest_difference_ =
        std::max(largest_difference_, std::isfinite(share) ? share : std::numeric_limits<double>::infinity());
  }
}

CellRecord GatheredCells::record_at(const RecordPlace& place) const {
  return record_of_frame(files_[place.file].text().substr(place.at));
}

CellRecord GatheredCells::record(std::uint64_t cell) const { return record_at(places_.at(cell)); }

}  // namespace kerf::bench
