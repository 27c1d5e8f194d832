#include <algorithm>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>

#include <kerf/schema/recording_file.h>

#include "apart/reader_process.h"

namespace kerf::schema {
namespace {

constexpr std::size_t index_of(Column column) { return static_cast<std::size_t>(column); }

constexpr bool is_of_floats(Column column) { return column >= Column::wake_latency; }

}  // namespace

struct RecordingFile::Implementation {
  Implementation(const std::filesystem::path& file, Texts texts) : path(file), reader(file, "a recording") {
    using apart::Ask;
    constexpr int texts_patience_ms = 20'000;
    if (texts == Texts::looked_through_later) reader.set_timeout(texts_patience_ms);
    reader.begin(
        {.what = texts == Texts::looked_through ? Ask::recording : Ask::recording_with_trusted_texts});
    facts = reader.get_facts();
    reader.end();
    reader.set_timeout(std::nullopt);
  }

  template <typename T>
  void read(std::size_t dataset, std::uint64_t first, std::uint64_t count, std::span<T> values) const {
    const std::size_t width = dataset < facts.widths.size() ? facts.widths.at(dataset) : 1;
    if (width == 0) throw std::invalid_argument(path.string() + " has no such column");
    if (first > facts.rows || count > facts.rows - first) {
      throw std::out_of_range(path.string() + " has " + std::to_string(facts.rows) + " rows, not the " +
                              std::to_string(count) + " from " + std::to_string(first) + " on");
    }
    if (values.size() != count * width) throw std::invalid_argument("values and rows differ in number");
    if (count == 0) return;
    const std::scoped_lock one_at_a_time(mutex);
    reader.begin({.what = apart::Ask::rows,
                  .dataset = static_cast<std::uint32_t>(dataset),
                  .first = first,
                  .rows = count});
    reader.get(std::as_writable_bytes(values));
    reader.end();
  }

  std::filesystem::path path;
  mutable std::mutex mutex;
  mutable apart::ReaderProcess reader;
  in_process::RecordingFacts facts;
};

RecordingFile::RecordingFile(const std::filesystem::path& file, Texts texts)
    : implementation_(std::make_unique<Implementation>(file, texts)) {}

RecordingFile::RecordingFile(RecordingFile&&) noexcept = default;
RecordingFile& RecordingFile::operator=(RecordingFile&&) noexcept = default;
RecordingFile::~RecordingFile() = default;

const Recording& RecordingFile::about() const noexcept { return implementation_->facts.about; }

std::uint64_t RecordingFile::rows() const noexcept { return implementation_->facts.rows; }

bool RecordingFile::is_live() const noexcept { return implementation_->facts.is_live; }

double RecordingFile::first_time_s() const noexcept { return implementation_->facts.first_time_s; }

double RecordingFile::last_time_s() const noexcept { return implementation_->facts.last_time_s; }

double RecordingFile::period_s() const noexcept { return implementation_->facts.period_s; }

std::size_t RecordingFile::width(Column column) const {
  return implementation_->facts.widths.at(index_of(column));
}

bool RecordingFile::has_flags() const noexcept {
  return implementation_->facts.widths[in_process::flags_dataset] > 0;
}

void RecordingFile::read(Column column, std::uint64_t first_row, std::uint64_t rows,
                         std::span<double> values) const {
  const auto& self = *implementation_;
  if (!is_of_floats(column)) return self.read(index_of(column), first_row, rows, values);
  if (rows != values.size()) throw std::invalid_argument("values and rows differ in number");
  std::vector<float> floats(values.size());
  read_timing(column, first_row, floats);
  std::ranges::copy(floats, values.begin());
}

void RecordingFile::read_timing(Column column, std::uint64_t first_row, std::span<float> values) const {
  if (!is_of_floats(column)) throw std::invalid_argument("not a part of a tick");
  implementation_->read(index_of(column), first_row, values.size(), values);
}

void RecordingFile::read_channel(std::size_t channel, std::uint64_t first_row,
                                 std::span<double> values) const {
  const auto& self = *implementation_;
  const std::size_t channels = self.facts.about.channels.size();
  if (channel >= channels) {
    throw std::invalid_argument(self.path.string() + " has " + std::to_string(channels) +
                                " channels, there is no channel " + std::to_string(channel));
  }
  self.read(in_process::first_channel + channel, first_row, values.size(), values);
}

void RecordingFile::read_ticks(std::uint64_t first_row, std::span<std::uint64_t> values) const {
  implementation_->read(in_process::tick_dataset, first_row, values.size(), values);
}

void RecordingFile::read_flags(std::uint64_t first_row, std::span<std::uint32_t> values) const {
  implementation_->read(in_process::flags_dataset, first_row, values.size(), values);
}

}  // namespace kerf::schema
