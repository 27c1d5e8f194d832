#include <algorithm>
#include <cstring>

#include <kerf/schema/sweep_tables.h>

#include "hdf5/files.h"
#include "hdf5/h5.h"

namespace kerf::schema {
namespace {

hid_t type_of(SweepColumn::Type type) {
  switch (type) {
    case SweepColumn::Type::whole:
      return h5::native<std::uint64_t>();
    case SweepColumn::Type::code:
      return h5::native<std::uint32_t>();
    case SweepColumn::Type::number:
      break;
  }
  return h5::native<double>();
}

template <typename T>
void write_as(hid_t dataset, hid_t type, std::span<const double> values, hsize_t first) {
  const std::vector<T> converted(values.begin(), values.end());
  h5::write(dataset, type, converted.size(), converted.data(), first);
}

}  // namespace

struct SweepTablesWriter::Parts {
  struct Column {
    h5::Handle dataset;
    SweepColumn::Type type;
    hsize_t rows;
  };

  explicit Parts(std::filesystem::path target) : file(std::move(target)), temporary(file) {}

  template <typename Work>
  void write(const Work& work) {
    try {
      work();
    } catch (const h5::Error& error) {
      throw write_error(file, output.cause_of(error));
    }
  }

  std::filesystem::path file;
  TemporaryFile temporary;
  h5::WritableFile output;
  std::vector<std::vector<Column>> tables;
};

SweepTablesWriter::SweepTablesWriter(std::filesystem::path file)
    : parts_(std::make_unique<Parts>(std::move(file))) {
  parts_->write([this] {
    parts_->output = parts_->temporary.create(h5::WritableFile::Format::timeless);
    const auto root = h5::open(parts_->output.id(), "/");
    h5::write_attribute(root.id(), "schema", std::string(sweep_tables_name));
    h5::write_attribute(root.id(), "schema_version", h5::native<std::uint32_t>(), {}, &sweep_tables_version);
    (void)h5::create_group(parts_->output.id(), "/values", true);
  });
}

SweepTablesWriter::~SweepTablesWriter() = default;

void SweepTablesWriter::describe(const std::string& name, const std::string& text) {
  parts_->write([&] { h5::write_attribute(h5::open(parts_->output.id(), "/").id(), name, text); });
}

void SweepTablesWriter::add_values(const std::string& input, const std::vector<std::string>& values) {
  parts_->write([&] {
    std::size_t room = 1;
    for (const std::string& value : values) room = std::max(room, value.size());
    const std::vector<h5::Field> fields{{.name = "text", .type = "text", .size = room, .offset = 0}};
    const h5::Handle type = h5::record_type(fields, room);
    std::string all(room * values.size(), '\0');
    for (std::size_t i = 0; i < values.size(); ++i)
      std::memcpy(all.data() + i * room, values[i].data(), values[i].size());
    const h5::Handle dataset =
        h5::create_dataset(parts_->output.id(), "/values/" + input, type.id(),
                           {.extent = {values.size()}, .contiguous = true, .timeless = true});
    if (!values.empty()) h5::write(dataset.id(), type.id(), all.data());
  });
}

std::size_t SweepTablesWriter::add_table(const std::string& name, std::uint64_t rows,
                                         const std::vector<SweepColumn>& columns) {
  parts_->write([&] {
    const h5::Handle group = h5::create_group(parts_->output.id(), "/" + name, true);
    std::vector<Parts::Column>& table = parts_->tables.emplace_back();
    for (const SweepColumn& column : columns) {
      h5::Handle dataset = h5::create_dataset(group.id(), column.name, type_of(column.type),
                                              {.extent = {rows}, .contiguous = true, .timeless = true});
      h5::write_attribute(dataset.id(), "units", column.unit);
      table.push_back({.dataset = std::move(dataset), .type = column.type, .rows = 0});
    }
  });
  return parts_->tables.size() - 1;
}

void SweepTablesWriter::append(std::size_t table, std::size_t column, std::span<const double> values) {
  if (values.empty()) return;
  Parts::Column& to = parts_->tables.at(table).at(column);
  parts_->write([&] {
    const hid_t dataset = to.dataset.id();
    const hid_t type = type_of(to.type);
    switch (to.type) {
      case SweepColumn::Type::number:
        h5::write(dataset, type, values.size(), values.data(), to.rows);
        break;
      case SweepColumn::Type::whole:
        write_as<std::uint64_t>(dataset, type, values, to.rows);
        break;
      case SweepColumn::Type::code:
        write_as<std::uint32_t>(dataset, type, values, to.rows);
        break;
    }
  });
  to.rows += values.size();
}

void SweepTablesWriter::commit(Existing existing) {
  parts_->write([this] {
    parts_->tables.clear();
    parts_->output.close();
  });
  parts_->temporary.commit(existing);
}

}  // namespace kerf::schema
