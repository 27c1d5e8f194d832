#include "inspect/first_look.h"

#include <algorithm>

#include <fmt/core.h>

#include <kerf/schema/recorded_rows.h>

#include "inspect/inspection.h"

namespace kerf::bench {
namespace {

constexpr std::size_t fewest_rows = 10;

/// The begin of a recording in memory.
class FirstRows final : public schema::RecordedRows {
 public:
  explicit FirstRows(const schema::Recording& recording) : all_(recording) {}

  [[nodiscard]] const schema::Recording& about() const noexcept override { return all_.about(); }
  [[nodiscard]] std::uint64_t rows() const noexcept override {
    return std::min<std::uint64_t>(all_.rows(), first_look_rows);
  }
  [[nodiscard]] std::size_t width(schema::Column column) const override { return all_.width(column); }
  [[nodiscard]] bool has_flags() const noexcept override { return all_.has_flags(); }
  void read(schema::Column column, std::uint64_t first_row, std::uint64_t rows,
            std::span<double> values) const override {
    all_.read(column, first_row, rows, values);
  }
  void read_channel(std::size_t channel, std::uint64_t first_row, std::span<double> values) const override {
    all_.read_channel(channel, first_row, values);
  }
  void read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const override {
    all_.read_ticks(first_row, values);
  }
  void read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const override {
    all_.read_flags(first_row, values);
  }

 private:
  schema::RowsInMemory all_;
};

}  // namespace

std::vector<std::string> first_look(const schema::Recording& recording, double felt) {
  if (recording.rows() < fewest_rows) return {};
  const FirstRows rows(recording);
  Inspection inspection = inspect(rows, {.axis = 0, .felt = felt});
  inspection.sampling.gaps = 0;
  inspection.sampling.not_finite = 0;
  for (InspectedSignal& signal : inspection.signals) signal.facts.not_finite = 0;
  if (rows.rows() < recording.rows()) inspection.cycles.cycles.clear();  // their numbers are of the whole
  std::vector<std::string> warnings = warnings_of(inspection);
  if (rows.rows() < recording.rows()) {
    for (std::string& warning : warnings)
      warning = fmt::format("in the first {} rows {}", first_look_rows, warning);
  }
  return warnings;
}

}  // namespace kerf::bench
