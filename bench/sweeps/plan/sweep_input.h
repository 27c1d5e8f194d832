#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kerf::bench {

/// What an input of a cell is set to.
using SweepValue = std::variant<double, std::string>;

/// A value as files and names of cells have it: numbers by the fewest digits that give back the same one.
[[nodiscard]] std::string value_text(const SweepValue& value);

/// Something that a verb takes and a sweep varies.
struct SweepInput {
  enum class Kind : std::uint8_t { number, whole, text, file, recording };

  std::string name;
  Kind kind = Kind::number;
  std::string what;  ///< in words
  std::string unit = "1";
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::vector<std::string> among{};      ///< texts that it may be; empty: any
  std::optional<SweepValue> standard{};  ///< where it is not given
  bool required = false;
  /// Of a file: others whose content counts with its own; none: it stands for itself.
  std::vector<std::filesystem::path> (*counts_with)(const std::filesystem::path& file) = nullptr;

  /// The content of what it names counts, and not the name.
  [[nodiscard]] bool is_file() const noexcept { return kind == Kind::file || kind == Kind::recording; }
  [[nodiscard]] bool is_text() const noexcept { return kind == Kind::text || is_file(); }
  /// What is wrong with a value; empty if nothing is.
  [[nodiscard]] std::string wrong_with(const SweepValue& value) const;
};

/// The values of one input: a list, or a range of numbers, which is never written out.
class InputValues {
 public:
  struct Range {
    double from = 0.0;
    double to = 0.0;
    std::uint64_t count = 1;
    bool logarithmic = false;
  };

  InputValues() = default;
  explicit InputValues(std::vector<SweepValue> listed) : listed_(std::move(listed)) {}
  explicit InputValues(const Range& range) : range_(range) {}

  /// 0: the input is not given.
  [[nodiscard]] std::uint64_t size() const noexcept { return range_ ? range_->count : listed_.size(); }
  /// Of a range rounded to twelve digits, so that every processor gives the same number.
  [[nodiscard]] SweepValue at(std::uint64_t place) const;
  [[nodiscard]] const std::vector<SweepValue>& listed() const noexcept { return listed_; }
  [[nodiscard]] const std::optional<Range>& range() const noexcept { return range_; }

 private:
  std::vector<SweepValue> listed_;
  std::optional<Range> range_;
};

}  // namespace kerf::bench
