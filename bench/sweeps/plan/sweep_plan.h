#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "plan/sweep_input.h"

namespace kerf::bench {

struct SweepVerb;

/// One cell: the inputs of its verb, in their order; none where nothing is given and there is no standard.
class SweepCell {
 public:
  SweepCell(const std::vector<SweepInput>& inputs, std::uint64_t number)
      : number_(number), inputs_(&inputs), values_(inputs.size()) {}

  [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
  [[nodiscard]] const std::vector<std::optional<SweepValue>>& values() const noexcept { return values_; }
  void set(std::size_t place, SweepValue value) { values_[place] = std::move(value); }

  [[nodiscard]] bool has(std::string_view input) const { return values_[place_of(input)].has_value(); }
  /// @throws std::invalid_argument where there is no value.
  [[nodiscard]] double number(std::string_view input) const;
  [[nodiscard]] const std::string& text(std::string_view input) const;

 private:
  [[nodiscard]] std::size_t place_of(std::string_view input) const;
  [[nodiscard]] const SweepValue& value(std::string_view input) const;

  std::uint64_t number_;
  const std::vector<SweepInput>* inputs_;
  std::vector<std::optional<SweepValue>> values_;
};

/// A product: every value of an input with every value of the others. The last input changes fastest.
struct SweepBlock {
  std::vector<InputValues> inputs;  ///< as many as the verb has
  [[nodiscard]] std::uint64_t cells() const;
};

/// A file that cells name, as it was when the sweep was planned.
struct PlannedFile {
  std::uintmax_t bytes = 0;
  std::string sha256;
};

/// How cells are run, which changes none of their numbers.
struct SweepLimits {
  double seconds = 60.0;        ///< of a cell
  std::size_t megabytes = 500;  ///< that a worker may take
};

/// What a sweep computes. A cell is a pure function of its number, so that no list of them is ever in memory.
/// Shards take the cells in blocks: shard i of n has those from i N / n on, so that each reads few
/// recordings.
struct SweepPlan {
  const SweepVerb* verb = nullptr;
  std::vector<SweepInput> inputs;  ///< of the verb
  std::vector<SweepBlock> blocks;
  std::filesystem::path folder;              ///< that the names of files are from
  std::map<std::string, PlannedFile> files;  ///< by the name that cells have
  SweepLimits limits;
  std::uint64_t shards = 1;

  static constexpr std::uint64_t most_cells = 1'000'000'000'000;

  [[nodiscard]] std::uint64_t cells() const;
  [[nodiscard]] SweepCell cell(std::uint64_t number) const;
  /// What a cell is, whatever sweep it is in: 32 hexadecimal digits of the SHA-256 over its verb and its
  /// inputs by name, recordings by their content. An input at its standard is no part of it, so that the
  /// same cell keeps its name when the verb learns to take more.
  [[nodiscard]] std::string name_of(const SweepCell& cell) const;

  /// What makes it this plan and no other: verb, blocks and files.
  [[nodiscard]] nlohmann::ordered_json as_json() const;
  /// SHA-256 of that.
  [[nodiscard]] std::string sha256() const;
};

/// The cells of a shard.
struct ShardRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
  [[nodiscard]] std::uint64_t size() const noexcept { return end - begin; }
};
[[nodiscard]] ShardRange shard_range(std::uint64_t cells, std::uint64_t shard, std::uint64_t shards);

}  // namespace kerf::bench
