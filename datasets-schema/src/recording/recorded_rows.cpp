#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <kerf/schema/recorded_rows.h>

namespace kerf::schema {
namespace {

using ColumnMember = std::variant<std::vector<double> Recording::*, std::vector<float> Recording::*>;

/// In the order of Column.
constexpr std::array<ColumnMember, 9> members{
    &Recording::time,           &Recording::position,     &Recording::velocity,  &Recording::force_commanded,
    &Recording::force_measured, &Recording::wake_latency, &Recording::read_time, &Recording::compute_time,
    &Recording::write_time};

template <typename From, typename To>
void copy_part(const std::vector<From>& from, std::size_t first, std::span<To> to) {
  if (first > from.size() || to.size() > from.size() - first) {
    throw std::out_of_range("recording: found " + std::to_string(from.size()) + " values, not " +
                            std::to_string(to.size()) + " from " + std::to_string(first) + " on");
  }
  std::ranges::copy(std::span(from).subspan(first, to.size()), to.begin());
}

}  // namespace

std::size_t RowsInMemory::width(Column column) const {
  if (recording_->rows() == 0) return 0;
  return std::visit([&](auto member) { return (recording_->*member).size() / recording_->rows(); },
                    members.at(static_cast<std::size_t>(column)));
}

void RowsInMemory::read(Column column, std::uint64_t first_row, std::uint64_t rows,
                        std::span<double> values) const {
  if (values.size() != rows * width(column)) throw std::invalid_argument("values and rows differ in number");
  std::visit([&](auto member) { copy_part(recording_->*member, first_row * width(column), values); },
             members.at(static_cast<std::size_t>(column)));
}

void RowsInMemory::read_channel(std::size_t channel, std::uint64_t first_row,
                                std::span<double> values) const {
  copy_part(recording_->channels.at(channel).values, first_row, values);
}

void RowsInMemory::read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const {
  copy_part(recording_->tick, first_row, values);
}

void RowsInMemory::read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const {
  copy_part(recording_->flags, first_row, values);
}

}  // namespace kerf::schema
