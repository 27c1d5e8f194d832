#include <mutex>
#include <stdexcept>

#include <kerf/schema/sweep_tables_file.h>

#include "apart/reader_process.h"

namespace kerf::schema {

struct SweepTablesFile::Implementation {
  explicit Implementation(const std::filesystem::path& of)
      : file(of),
        reader(of, "the tables of a sweep"),
        facts(reader.ask<SweepTablesFacts>({.what = apart::Ask::sweep_tables})) {}

  std::filesystem::path file;
  std::mutex mutex;
  apart::ReaderProcess reader;
  SweepTablesFacts facts;
};

SweepTablesFile::SweepTablesFile(const std::filesystem::path& file)
    : implementation_(std::make_unique<Implementation>(file)) {}

SweepTablesFile::SweepTablesFile(SweepTablesFile&&) noexcept = default;
SweepTablesFile& SweepTablesFile::operator=(SweepTablesFile&&) noexcept = default;
SweepTablesFile::~SweepTablesFile() = default;

const SweepTablesFacts& SweepTablesFile::facts() const noexcept { return implementation_->facts; }

std::vector<double> SweepTablesFile::column(std::size_t table, std::size_t column) const {
  const SweepTable& of = implementation_->facts.tables.at(table);
  if (column >= of.columns.size()) throw std::out_of_range(of.name + " has no such column");
  std::vector<double> values;
  const std::scoped_lock one_at_a_time(implementation_->mutex);
  implementation_->reader.begin({.what = apart::Ask::sweep_column,
                                 .dataset = static_cast<std::uint32_t>(table),
                                 .first = column,
                                 .rows = of.rows});
  implementation_->reader.get(values, of.rows);
  implementation_->reader.end();
  return values;
}

}  // namespace kerf::schema
