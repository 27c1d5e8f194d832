#include "fuzz/hdf5/edits.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "hdf5/h5.h"

namespace kerf::fuzz {
namespace {

namespace h5 = schema::h5;

/// Numbers and words taken off the bytes one by one; zeros at their end.
class Choices {
 public:
  explicit Choices(Bytes bytes) : rest_(bytes) {}

  [[nodiscard]] bool is_at_end() const { return rest_.empty(); }
  std::size_t below(std::size_t bound) {
    if (rest_.empty()) return 0;
    const std::size_t chosen = rest_.front() % bound;
    rest_ = rest_.subspan(1);
    return chosen;
  }
  template <typename Range>
  const auto& of(const Range& range) {
    return range[below(std::size(range))];
  }

 private:
  Bytes rest_;
};

constexpr std::array words{"recording",
                           "complete",
                           "aborted: why",
                           "kerf.recording",
                           "kerf.regression",
                           "kerf.session",
                           "",
                           "m",
                           "rad",
                           "N",
                           "N·m",
                           "1",
                           "plan",
                           "a\nb\x1b[31m",
                           "\xff\xfe",
                           "key file",
                           "passphrase",
                           "/samples",
                           "..",
                           "2026-01-31T12:00:00Z"};
constexpr std::array names{"schema", "schema_version", "status", "axes",     "units",  "time",
                           "x",      "a\nb",           "force",  "channels", "0",      "1",
                           "events", "toml",           "uri",    "axis",     "faults", "phases",
                           "grid",   "position",       "name",   "CLASS",    "salt",   "kind"};
constexpr std::array<hsize_t, 12> lengths{
    0, 1, 2, 3, 4, 5, 6, 7, 16, 1000, hsize_t{1} << 33U, hsize_t{1} << 63U};
constexpr std::array numbers{0.0,
                             1.0,
                             -1.0,
                             0.5,
                             3.0,
                             1e300,
                             -1e-300,
                             std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()};

/// All groups and datasets, links that lead back left out.
std::vector<std::string> objects_in(hid_t file) {
  constexpr std::size_t max_objects = 100;
  std::vector<std::string> all{"/"};
  for (std::size_t i = 0; i < all.size() && all.size() < max_objects; ++i) {
    if (!h5::is_group(file, all[i]) || std::ranges::count(all[i], '/') > 3) continue;
    const std::string parent = all[i] == "/" ? "" : all[i];
    for (const std::string& name : h5::children(h5::open(file, all[i]).id()))
      all.push_back(parent + '/' + name);
  }
  return all;
}

h5::Handle text_type(std::size_t size) {
  h5::Handle type(h5::call(H5Tcopy, H5T_C_S1));
  h5::call(H5Tset_size, type.id(), size);
  return type;
}

h5::Handle record_of(Choices& choices) {
  const std::array<const char*, 5> fields{"time", "kind", "text", "begin", "end"};
  const std::array<const char*, 5> types{"float64", "text", "uint64", "uint32", "uint8"};
  std::vector<h5::Field> all;
  std::size_t offset = 0;
  const std::size_t count = 1 + choices.below(4);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string type = choices.of(types);
    const std::size_t size = type == "text" ? 1 + choices.below(40) : 8;
    all.push_back({fields[i], type, size, offset});
    offset += size;
  }
  return h5::record_type(all, offset);
}

h5::Handle any_type(Choices& choices) {
  switch (choices.below(11)) {
    case 0:
      return h5::Handle(h5::call(H5Tcopy, h5::native<double>()));
    case 1:
      return h5::Handle(h5::call(H5Tcopy, h5::native<float>()));
    case 2:
      return h5::Handle(h5::call(H5Tcopy, h5::native<std::uint64_t>()));
    case 3:
      return h5::Handle(h5::call(H5Tcopy, h5::native<std::uint32_t>()));
    case 4:
      return h5::Handle(h5::call(H5Tcopy, h5::native<std::uint8_t>()));
    case 5:
      return h5::Handle(h5::call(H5Tcopy, H5T_STD_I32BE));
    case 6:
      return text_type(1 + choices.below(64));
    case 7:
      return text_type(std::size_t{1} << 24U);
    case 8:
      return record_of(choices);
    case 9:
      return h5::Handle(h5::call(H5Tvlen_create, h5::native<double>()));
    default:
      return text_type(H5T_VARIABLE);
  }
}

h5::Extent any_extent(Choices& choices) {
  h5::Extent extent(choices.below(4));
  for (hsize_t& length : extent) length = choices.of(lengths);
  return extent;
}

std::string child_of(const std::string& group, const std::string& name) {
  return group == "/" ? group + name : group + '/' + name;
}

/// Takes an attribute away, and puts another in its place.
void edit_attribute(hid_t object, Choices& choices) {
  const auto present = h5::attributes(object);
  const bool is_new = present.empty() || choices.below(4) == 0;
  const std::string name = is_new ? choices.of(names) : choices.of(present);
  if (h5::has_attribute(object, name)) h5::delete_attribute(object, name);
  switch (choices.below(5)) {
    case 0:
      return;
    case 1:
      return h5::write_attribute(object, name, choices.of(words));
    case 2: {
      std::vector<std::string> texts(choices.below(8));
      for (std::string& text : texts) text = choices.of(words);
      return h5::write_attribute(object, name, texts);
    }
    case 3: {
      const std::size_t rank = choices.below(3);
      const h5::Extent extent(rank, rank == 0 ? 1 : 1 + choices.below(7));
      const std::vector<double> values(64, choices.of(numbers));
      return h5::write_attribute(object, name, h5::native<double>(), extent, values.data());
    }
    default: {
      const auto type = any_type(choices);
      const h5::Handle space(h5::call(H5Screate, choices.below(2) == 0 ? H5S_NULL : H5S_SCALAR));
      const h5::Handle made(
          h5::call(H5Acreate2, object, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT));
    }
  }
}

/// Another dataset in the place of one, or a new one.
void put_dataset(hid_t file, const std::string& path, Choices& choices) {
  if (h5::is_group(file, path) || h5::is_dataset(file, path))
    h5::call(H5Ldelete, file, path.c_str(), H5P_DEFAULT);
  const auto type = any_type(choices);
  h5::Extent extent = any_extent(choices);
  const bool is_contiguous = extent.empty() || choices.below(2) == 0;
  const h5::DatasetOptions options{.extent = extent,
                                   .chunk_rows = 1 + choices.below(16),
                                   .compressed = !is_contiguous && choices.below(2) == 0,
                                   .contiguous = is_contiguous};
  const auto dataset = h5::create_dataset(file, path, type.id(), options);
  h5::write_attribute(dataset.id(), "units", choices.of(words));
}

void edit_values(hid_t dataset, Choices& choices) {
  const auto extent = h5::describe(dataset).extent;
  double values = 1.0;
  for (const hsize_t length : extent) values *= static_cast<double>(length);
  constexpr double max_values = 4096.0;
  if (values > max_values) return;
  std::vector<double> all(static_cast<std::size_t>(values));
  for (double& value : all) value = choices.of(numbers);
  h5::write(dataset, h5::native<double>(), all.data());
}

void edit_extent(hid_t dataset, Choices& choices) {
  h5::Extent extent = h5::describe(dataset).extent;
  for (hsize_t& length : extent) length = choices.below(2) == 0 ? length : choices.of(lengths);
  h5::call(H5Dset_extent, dataset, extent.data());
}

void link(hid_t file, const std::string& from, const std::string& to, Choices& choices) {
  switch (choices.below(3)) {
    case 0:
      h5::call(H5Lcreate_soft, from.c_str(), file, to.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      return;
    case 1:
      h5::call(H5Lcreate_hard, file, from.c_str(), file, to.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      return;
    default:
      h5::call(H5Lmove, file, from.c_str(), file, to.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  }
}

void edit_once(hid_t file, Choices& choices) {
  const auto objects = objects_in(file);
  const std::string path = choices.of(objects);
  const std::string beside = child_of(choices.of(objects), choices.of(names));
  switch (choices.below(9)) {
    case 0:
      h5::call(H5Ldelete, file, path.c_str(), H5P_DEFAULT);
      return;
    case 1:
      return put_dataset(file, path, choices);
    case 2:
      return put_dataset(file, beside, choices);
    case 3:
      static_cast<void>(h5::create_group(file, beside));
      return;
    case 4:
      return link(file, path, beside, choices);
    case 5:
      return edit_extent(h5::open(file, path).id(), choices);
    case 6:
      return edit_values(h5::open(file, path).id(), choices);
    default:
      return edit_attribute(h5::open(file, path).id(), choices);
  }
}

}  // namespace

void edit_hdf5(const std::filesystem::path& file, Bytes bytes) {
  constexpr int max_edits = 12;
  auto opened = h5::WritableFile::open(file);
  Choices choices(bytes);
  for (int edit = 0; edit < max_edits && !choices.is_at_end(); ++edit) {
    try {
      edit_once(opened.id(), choices);
    } catch (const h5::Error&) {
      continue;
    }
  }
  opened.close();
}

}  // namespace kerf::fuzz
