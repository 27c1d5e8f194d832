#include <algorithm>
#include <set>
#include <stdexcept>

#include <kerf/schema/regression.h>

#include "hdf5/files.h"
#include "hdf5/h5.h"
#include "in_process.h"
#include "layout/regression_layout.h"
#include "validate/inspect.h"

namespace kerf::schema {
namespace {

constexpr hsize_t force_chunk_rows = 8192;

void require_sound(const std::vector<StoredForces>& cases) {
  std::set<std::string> names;
  for (const StoredForces& one : cases) {
    if (one.name.empty() || one.name == "." || one.name == ".." || one.name.find('/') != std::string::npos)
      throw std::invalid_argument("stored forces: '" + one.name + "' is no name; expected one without '/'");
    if (!names.insert(one.name).second)
      throw std::invalid_argument("stored forces: there are two cases named '" + one.name + "'");
    if (!one.compute_time_s.empty() && one.compute_time_s.size() != one.rows())
      throw std::invalid_argument("stored forces: '" + one.name +
                                  "' has compute times for another number of rows");
    if (one.channels.empty() || one.force.size() % one.channels.size() != 0) {
      throw std::invalid_argument("stored forces: '" + one.name + "' has " +
                                  std::to_string(one.force.size()) + " numbers for " +
                                  std::to_string(one.channels.size()) + " channels");
    }
    const StoredTrajectory& path = one.trajectory;
    if (path.position.size() != path.time_s.size() * path.axes.size() || path.empty() != path.axes.empty())
      throw std::invalid_argument("stored forces: the trajectory of '" + one.name +
                                  "' does not fill its rows");
  }
}

std::vector<std::string> gather(const std::vector<ForceChannel>& channels,
                                std::string ForceChannel::*member) {
  std::vector<std::string> all;
  for (const ForceChannel& channel : channels) all.push_back(channel.*member);
  return all;
}

void write_compute_time(hid_t group, const StoredForces& one) {
  if (one.compute_time_s.empty()) return;
  const hsize_t rows = one.compute_time_s.size();
  const auto dataset = h5::create_dataset(
      group, "compute_time", h5::native<double>(),
      {.extent = {rows}, .chunk_rows = std::min<hsize_t>(rows, force_chunk_rows), .compressed = true});
  h5::write_attribute(dataset.id(), "of", one.compute_time_of);
  h5::write(dataset.id(), h5::native<double>(), one.compute_time_s.data());
}

void write_case(hid_t cases, const StoredForces& one) {
  const auto group = h5::create_group(cases, one.name);
  for (const auto& [name, member] : texts_of_a_case) h5::write_attribute(group.id(), name, one.*member);
  if (!one.renderer.empty()) h5::write_attribute(group.id(), "renderer", one.renderer);
  if (!one.made_with.empty()) h5::write_attribute(group.id(), "made_with", one.made_with);
  write_compute_time(group.id(), one);
  h5::write_attribute(group.id(), "faults", h5::native<std::uint64_t>(), {}, &one.faults);
  if (one.tick_cost) {
    h5::write_attribute(group.id(), "tick_cost", h5::native<double>(), {}, &*one.tick_cost);
    h5::write_attribute(group.id(), "tick_cost_build", one.tick_cost_build);
  }
  const h5::Extent extent{one.rows(), one.channels.size()};
  const auto dataset = h5::create_dataset(
      group.id(), "force", h5::native<double>(),
      {.extent = extent, .chunk_rows = std::min<hsize_t>(extent[0], force_chunk_rows), .compressed = true});
  h5::write_attribute(dataset.id(), "channels", gather(one.channels, &ForceChannel::name));
  h5::write_attribute(dataset.id(), "units", gather(one.channels, &ForceChannel::unit));
  if (!one.force.empty()) h5::write(dataset.id(), h5::native<double>(), one.force.data());
}

void write_columns(hid_t group, const char* name, const h5::Extent& extent,
                   const std::vector<double>& values) {
  const auto dataset = h5::create_dataset(
      group, name, h5::native<double>(),
      {.extent = extent, .chunk_rows = std::min<hsize_t>(extent[0], force_chunk_rows), .compressed = true});
  h5::write(dataset.id(), h5::native<double>(), values.data());
}

/// Each trajectory once, whatever number of cases has it.
void write_trajectories(hid_t file, const std::vector<StoredForces>& cases) {
  std::set<std::string> written;
  for (const StoredForces& one : cases) {
    const StoredTrajectory& path = one.trajectory;
    if (path.empty() || one.trajectory_sha256.empty()) continue;
    if (written.empty()) static_cast<void>(h5::create_group(file, group_of_trajectories));
    if (!written.insert(one.trajectory_sha256).second) continue;
    const auto group = h5::create_group(file, group_of_trajectories + '/' + one.trajectory_sha256);
    h5::write_attribute(group.id(), "axes", gather(path.axes, &ForceChannel::name));
    h5::write_attribute(group.id(), "units", gather(path.axes, &ForceChannel::unit));
    write_columns(group.id(), "time", {path.time_s.size()}, path.time_s);
    write_columns(group.id(), "position", {path.time_s.size(), path.axes.size()}, path.position);
  }
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw FormatError(one_line(file.string() + ": " + what));
}

/// The text of an attribute; empty if it is not there.
std::string text_of(hid_t object, const std::string& name) {
  if (!h5::has_attribute(object, name)) return {};
  if (h5::describe_attribute(object, name).type != "text") return {};
  const auto all = h5::read_texts(object, name);
  return all.empty() ? std::string() : all.front();
}

bool has_number(hid_t object, const std::string& name, const std::string& type) {
  if (!h5::has_attribute(object, name)) return false;
  const h5::Description found = h5::describe_attribute(object, name);
  return found.type == type && found.extent.empty();
}

void read_compute_time(const std::filesystem::path& file, hid_t group, const std::string& where,
                       StoredForces& one) {
  if (!h5::is_dataset(group, "compute_time")) return;
  const auto dataset = h5::open(group, "compute_time");
  const h5::Description about = h5::describe(dataset.id());
  if (about.type != "float64" || about.extent.size() != 1)
    refuse(file, where + "/compute_time: found " + about.type + ", expected float64 of N");
  if (!h5::is_plausible(dataset.id(), std::filesystem::file_size(file)))
    refuse(file, where + "/compute_time: found more values than the file can hold");
  one.compute_time_of = text_of(dataset.id(), "of");
  one.compute_time_s.resize(about.extent[0]);
  if (!one.compute_time_s.empty())
    h5::read(dataset.id(), h5::native<double>(), about.extent[0], one.compute_time_s.data());
}

/// The names and units of as many columns, from two attributes.
std::vector<ForceChannel> read_columns(const std::filesystem::path& file, hid_t object,
                                       const std::string& where, const char* name_list, std::size_t count) {
  for (const char* list : {name_list, "units"}) {
    if (h5::has_attribute(object, list) && h5::describe_attribute(object, list).type == "text" &&
        h5::read_texts(object, list).size() == count) {
      continue;
    }
    refuse(file, where + ": expected the attribute '" + list + "', one text a column");
  }
  const auto names = h5::read_texts(object, name_list);
  const auto units = h5::read_texts(object, "units");
  std::vector<ForceChannel> columns;
  for (std::size_t i = 0; i < names.size(); ++i) columns.push_back({names[i], units[i]});
  return columns;
}

/// A dataset of float64 with so many dimensions. `extent`: as it is in the file.
std::vector<double> read_values(const std::filesystem::path& file, hid_t group, const std::string& where,
                                const char* name, std::size_t dimensions, h5::Extent& extent) {
  const std::string place = where + '/' + name;
  if (!h5::is_dataset(group, name)) refuse(file, place + ": there is no such dataset");
  const auto dataset = h5::open(group, name);
  const h5::Description about = h5::describe(dataset.id());
  if (about.type != "float64" || about.extent.size() != dimensions || about.extent.back() == 0)
    refuse(file,
           place + ": found " + about.type + ", expected float64 of N" + (dimensions > 1 ? " x D" : ""));
  if (!h5::is_plausible(dataset.id(), std::filesystem::file_size(file)))
    refuse(file, place + ": found more values than the file can hold");
  extent = about.extent;
  std::vector<double> values(extent[0] * (dimensions > 1 ? extent[1] : 1));
  if (!values.empty()) h5::read(dataset.id(), h5::native<double>(), extent[0], values.data());
  return values;
}

StoredTrajectory read_trajectory(const std::filesystem::path& file, hid_t root, const std::string& sha256) {
  const std::string where = group_of_trajectories + '/' + sha256;
  if (sha256.empty() || sha256.find('/') != std::string::npos || !h5::is_group(root, group_of_trajectories) ||
      !h5::is_group(root, where)) {
    return {};
  }
  const auto group = h5::open(root, where);
  h5::Extent rows;
  h5::Extent extent;
  StoredTrajectory path;
  path.time_s = read_values(file, group.id(), where, "time", 1, rows);
  path.position = read_values(file, group.id(), where, "position", 2, extent);
  if (extent[0] != rows[0]) refuse(file, where + ": 'time' and 'position' have other numbers of rows");
  path.axes = read_columns(file, group.id(), where, "axes", extent[1]);
  return path;
}

StoredForces read_case(const std::filesystem::path& file, hid_t cases, const std::string& name) {
  const std::string where = group_of_cases + '/' + name;
  if (!h5::is_group(cases, name)) refuse(file, where + ": found no group, expected one a case");
  const auto group = h5::open(cases, name);
  StoredForces one;
  one.name = name;
  for (const auto& [attribute, member] : texts_of_a_case) one.*member = text_of(group.id(), attribute);
  one.renderer = text_of(group.id(), "renderer");
  one.made_with = text_of(group.id(), "made_with");
  read_compute_time(file, group.id(), where, one);
  if (has_number(group.id(), "faults", "uint64"))
    h5::read_attribute(group.id(), "faults", h5::native<std::uint64_t>(), &one.faults);
  if (has_number(group.id(), "tick_cost", "float64")) {
    one.tick_cost = 0.0;
    h5::read_attribute(group.id(), "tick_cost", h5::native<double>(), &*one.tick_cost);
    one.tick_cost_build = text_of(group.id(), "tick_cost_build");
  }
  h5::Extent extent;
  one.force = read_values(file, group.id(), where, "force", 2, extent);
  one.channels =
      read_columns(file, h5::open(group.id(), "force").id(), where + "/force", "channels", extent[1]);
  return one;
}

void require_schema(const std::filesystem::path& file, hid_t root) {
  const std::string schema = text_of(root, "schema");
  if (schema != regression_schema_name) {
    refuse(file, "found " + (schema.empty() ? "no schema" : "the schema '" + schema + "'") +
                     ", expected stored forces ('" + std::string(regression_schema_name) +
                     "'), as 'kerf regress update' writes them");
  }
  std::uint32_t version = 0;
  if (has_number(root, "schema_version", "uint32"))
    h5::read_attribute(root, "schema_version", h5::native<std::uint32_t>(), &version);
  if (version != regression_schema_version) {
    refuse(file, "found version " + std::to_string(version) + " of " + schema + ", expected " +
                     std::to_string(regression_schema_version));
  }
}

}  // namespace

std::vector<StoredForces> in_process::read_regression(const std::filesystem::path& file) {
  require_hdf5(file, "stored forces");
  try {
    const auto opened = h5::open_file(file);
    require_sound_texts(file, opened);
    require_schema(file, h5::open(opened.id(), "/").id());
    if (!h5::is_group(opened.id(), group_of_cases)) refuse(file, "there is no group " + group_of_cases);
    const auto cases = h5::open(opened.id(), group_of_cases);
    std::vector<StoredForces> all;
    for (const std::string& name : h5::children(cases.id())) {
      all.push_back(read_case(file, cases.id(), name));
      all.back().trajectory = read_trajectory(file, opened.id(), all.back().trajectory_sha256);
    }
    return all;
  } catch (const h5::Error& error) {
    throw DamageError(file, error.what());
  }
}

void write_regression(const std::filesystem::path& file, const std::vector<StoredForces>& cases) {
  require_sound(cases);
  TemporaryFile temporary(file);
  h5::WritableFile output;
  try {
    output = temporary.create();
    {
      const auto root = h5::open(output.id(), "/");
      h5::write_attribute(root.id(), "schema", std::string(regression_schema_name));
      h5::write_attribute(root.id(), "schema_version", h5::native<std::uint32_t>(), {},
                          &regression_schema_version);
      const auto group = h5::create_group(output.id(), group_of_cases);
      for (const StoredForces& one : cases) write_case(group.id(), one);
      write_trajectories(output.id(), cases);
    }
    output.close();
  } catch (const h5::Error& error) {
    throw write_error(file, output.cause_of(error));
  }
  temporary.commit(Existing::replace);
}

}  // namespace kerf::schema
