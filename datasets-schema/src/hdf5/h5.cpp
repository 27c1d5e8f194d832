#include "hdf5/h5.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <thread>

namespace kerf::schema::h5 {
namespace {

// HDF5 names the system's error only inside its text: "..., errno = 28, error message = '...'".
int errno_in(std::string_view text) {
  constexpr std::string_view mark = "errno = ";
  const auto at = text.find(mark);
  int number = 0;
  if (at != std::string_view::npos) {
    std::from_chars(text.data() + at + mark.size(), text.data() + text.size(), number);
  }
  return number;
}

herr_t keep_innermost(unsigned /*depth*/, const H5E_error2_t* error, void* line) {
  auto& text = *static_cast<std::string*>(line);
  if (text.empty() && error->desc != nullptr) text = error->desc;
  return 0;
}

Handle dataspace(const Extent& extent, bool growing) {
  if (extent.empty()) return Handle(call(H5Screate, H5S_SCALAR));
  Extent most = extent;
  if (growing) most.front() = H5S_UNLIMITED;
  return Handle(call(H5Screate_simple, static_cast<int>(extent.size()), extent.data(), most.data()));
}

Extent extent_of(const Handle& space) {
  if (call(H5Sget_simple_extent_type, space.id()) == H5S_NULL) return {0};
  Extent extent(static_cast<std::size_t>(call(H5Sget_simple_extent_ndims, space.id())));
  if (!extent.empty()) call(H5Sget_simple_extent_dims, space.id(), extent.data(), nullptr);
  return extent;
}

Handle text_type(std::size_t size) {
  Handle type(call(H5Tcopy, H5T_C_S1));
  call(H5Tset_size, type.id(), size);
  call(H5Tset_cset, type.id(), H5T_CSET_UTF8);
  if (size != H5T_VARIABLE) call(H5Tset_strpad, type.id(), H5T_STR_NULLPAD);
  return type;
}

Handle property_list(hid_t kind) { return Handle(call(H5Pcreate, kind)); }

/// Names of links and of attributes are UTF-8.
Handle utf8_names(hid_t kind) {
  auto properties = property_list(kind);
  call(H5Pset_char_encoding, properties.id(), H5T_CSET_UTF8);
  return properties;
}

std::string number_name(hid_t type, std::string_view kind) {
  return std::string(kind) +
         std::to_string(8 * call([](hid_t id) { return static_cast<long long>(H5Tget_size(id)); }, type));
}

std::string record_name(hid_t type) {
  std::string name = "{";
  const int fields = call(H5Tget_nmembers, type);
  for (unsigned i = 0; i < static_cast<unsigned>(fields); ++i) {
    char* field = H5Tget_member_name(type, i);
    name += (i > 0 ? ", " : "") + std::string(field == nullptr ? "?" : field);
    H5free_memory(field);
    const Handle member(call(H5Tget_member_type, type, i));
    const bool variable =
        call(H5Tget_class, member.id()) == H5T_STRING && call(H5Tis_variable_str, member.id()) > 0;
    name += (variable ? " variable-length " : " ") + type_name(member.id());
  }
  return name + '}';
}

}  // namespace

void silence() noexcept {
  // At exit HDF5 would flush what could not be written, over and over; every file is closed before that.
  static const herr_t stays_quiet_at_exit = H5dont_atexit();
  thread_local const herr_t prints_nothing = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  static_cast<void>(stays_quiet_at_exit);
  static_cast<void>(prints_nothing);
}

void throw_last_error() {
  std::string line;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, &keep_innermost, &line);
  if (line.empty()) line = "HDF5 gives no reason";
  const int cause = errno_in(line);
  throw Error(cause == 0 ? line : std::strerror(cause), cause);
}

Handle::~Handle() {
  if (id_ == none) return;
  silence();
  H5Idec_ref(id_);
}

void Handle::close() {
  if (id_ != none) call(H5Idec_ref, std::exchange(id_, none));
}

WritableFile WritableFile::create(const std::filesystem::path& file, Format format) {
  auto failure = std::make_unique<int>(0);
  const auto access = sturdy_access(*failure);
  const auto version = format == Format::live_readers ? H5F_LIBVER_V110 : H5F_LIBVER_V18;
  call(H5Pset_libver_bounds, access.id(), version, version);
  const auto creation = property_list(H5P_FILE_CREATE);
  if (format == Format::live_readers) {
    // A kill can cut a write in two where it crosses a page of memory. No part of the file's own structure
    // does: each lies within a page, and is there as it was before or as it is after.
    constexpr hsize_t page = 4096;
    constexpr hsize_t smallest_hole = 1;
    call(H5Pset_file_space_strategy, creation.id(), H5F_FSPACE_STRATEGY_PAGE, hbool_t{false}, smallest_hole);
    call(H5Pset_file_space_page_size, creation.id(), page);
    // Rows are written once. HDF5 would keep a megabyte of the chunks of each dataset, in a process whose
    // memory is locked; it says that the first number is used by nothing.
    call(H5Pset_cache, access.id(), 0, std::size_t{1}, std::size_t{0}, 1.0);
  }
  return {std::move(failure),
          Handle(call(H5Fcreate, file.c_str(), H5F_ACC_EXCL, creation.id(), access.id()))};
}

WritableFile WritableFile::open(const std::filesystem::path& file) {
  auto failure = std::make_unique<int>(0);
  const auto access = sturdy_access(*failure);
  // A reader locks a file for the moment in which it learns that the file is written.
  constexpr int max_attempts = 20;
  for (int attempt = 1;; ++attempt) {
    try {
      Handle handle(call(H5Fopen, file.c_str(), H5F_ACC_RDWR, access.id()));
      return {std::move(failure), std::move(handle)};
    } catch (const Error& error) {
      const bool is_locked = std::string_view(error.what()).find("unable to lock") != std::string_view::npos;
      if (!is_locked || attempt == max_attempts) throw;
      std::this_thread::sleep_for(std::chrono::milliseconds(attempt));
    }
  }
}

void WritableFile::start_live() {
  call(H5Fflush, id(), H5F_SCOPE_LOCAL);
  check();
  call(H5Fstart_swmr_write, id());
}

void WritableFile::check() const {
  if (failure_ && *failure_ != 0) throw Error(std::strerror(*failure_), *failure_);
}

void WritableFile::close() {
  handle_.close();
  check();
}

Error WritableFile::cause_of(const Error& error) const {
  if (failure_ && *failure_ != 0) return {std::strerror(*failure_), *failure_};
  return error;
}

bool is_hdf5(const std::filesystem::path& file) {
  silence();
  return H5Fis_hdf5(file.c_str()) > 0;
}

Handle open_file(const std::filesystem::path& file) {
  try {
    return Handle(call(H5Fopen, file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  } catch (const Error& error) {
    const std::string_view why(error.what());
    // The second is said where another thread follows the file just now.
    if (why.find("already open for") == std::string_view::npos &&
        why.find("locking flag values don't match") == std::string_view::npos) {
      throw;
    }
    // Each attempt to read what is just being written waits twice as long as the one before: 34 ms in all.
    const auto access = property_list(H5P_FILE_ACCESS);
    call(H5Pset_metadata_read_attempts, access.id(), 25U);
    // Whoever follows a recording must not keep its writer from closing it.
    call(H5Pset_file_locking, access.id(), hbool_t{false}, hbool_t{true});
    const hid_t live = H5Fopen(file.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.id());
    if (live < 0) throw;
    return Handle(live);
  }
}

std::size_t block_alignment(hid_t file) {
  const Handle creation(call(H5Fget_create_plist, file));
  H5F_fspace_strategy_t strategy = H5F_FSPACE_STRATEGY_AGGR;
  hbool_t persists = false;
  hsize_t threshold = 0;
  hsize_t page = 0;
  call(H5Pget_file_space_strategy, creation.id(), &strategy, &persists, &threshold);
  call(H5Pget_file_space_page_size, creation.id(), &page);
  // Texts come in blocks of 4096 bytes at least; smaller than a page, they may lie anywhere in it.
  return strategy == H5F_FSPACE_STRATEGY_PAGE && page <= 4096 ? static_cast<std::size_t>(page) : 1;
}

namespace {

bool exists(hid_t parent, const std::string& path) {
  for (auto end = path.find('/', 1);; end = path.find('/', end + 1)) {
    const auto part = path.substr(0, end);
    if (part != "/" && call(H5Lexists, parent, part.c_str(), H5P_DEFAULT) == 0) return false;
    if (end == std::string::npos) break;
  }
  return path == "/" || call(H5Oexists_by_name, parent, path.c_str(), H5P_DEFAULT) > 0;
}

bool is_kind(hid_t parent, const std::string& path, H5I_type_t kind) {
  return exists(parent, path) && H5Iget_type(open(parent, path).id()) == kind;
}

}  // namespace

bool is_group(hid_t parent, const std::string& path) { return is_kind(parent, path, H5I_GROUP); }

bool is_dataset(hid_t parent, const std::string& path) { return is_kind(parent, path, H5I_DATASET); }

Handle create_group(hid_t parent, const std::string& path) {
  const auto creation = property_list(H5P_GROUP_CREATE);
  call(H5Pset_link_creation_order, creation.id(), 0U | H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  return Handle(
      call(H5Gcreate2, parent, path.c_str(), utf8_names(H5P_LINK_CREATE).id(), creation.id(), H5P_DEFAULT));
}

Handle open(hid_t parent, const std::string& path) {
  return Handle(call(H5Oopen, parent, path.c_str(), H5P_DEFAULT));
}

namespace {

/// Bytes of a chunk that has to be unpacked as a whole; 0 for any other.
std::size_t bytes_to_unpack(hid_t dataset) {
  const Handle creation(call(H5Dget_create_plist, dataset));
  if (H5Pget_layout(creation.id()) != H5D_CHUNKED || call(H5Pget_nfilters, creation.id()) == 0) return 0;
  Extent chunk(extent_of(Handle(call(H5Dget_space, dataset))).size());
  call(H5Pget_chunk, creation.id(), static_cast<int>(chunk.size()), chunk.data());
  std::size_t bytes = H5Tget_size(Handle(call(H5Dget_type, dataset)).id());
  for (const auto length : chunk) bytes *= length;
  return bytes;
}

}  // namespace

Handle open_to_pass_through(hid_t parent, const std::string& path) {
  // What is open already would be opened with the cache that it has.
  const std::size_t bytes = bytes_to_unpack(open(parent, path).id());
  constexpr std::size_t max_bytes = std::size_t{32} << 20U;
  const auto access = property_list(H5P_DATASET_ACCESS);
  call(H5Pset_chunk_cache, access.id(), std::size_t{11}, std::min(bytes, max_bytes),
       H5D_CHUNK_CACHE_W0_DEFAULT);
  return Handle(call(H5Dopen2, parent, path.c_str(), access.id()));
}

std::vector<std::string> children(hid_t group) {
  std::vector<std::string> names;
  const H5L_iterate_t collect = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  const Handle creation(call(H5Gget_create_plist, group));
  unsigned order = 0;
  call(H5Pget_link_creation_order, creation.id(), &order);
  const auto index = (order & H5P_CRT_ORDER_TRACKED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
  call(H5Literate, group, index, H5_ITER_INC, nullptr, collect, &names);
  return names;
}

template <>
hid_t native<double>() {
  silence();
  return H5T_NATIVE_DOUBLE;
}
template <>
hid_t native<float>() {
  silence();
  return H5T_NATIVE_FLOAT;
}
template <>
hid_t native<std::uint64_t>() {
  silence();
  return H5T_NATIVE_UINT64;
}
template <>
hid_t native<std::uint32_t>() {
  silence();
  return H5T_NATIVE_UINT32;
}
template <>
hid_t native<std::uint8_t>() {
  silence();
  return H5T_NATIVE_UINT8;
}

std::string type_name(hid_t type) {
  switch (call(H5Tget_class, type)) {
    case H5T_FLOAT:
      return number_name(type, "float");
    case H5T_INTEGER:
      return number_name(type, call(H5Tget_sign, type) == H5T_SGN_NONE ? "uint" : "int");
    case H5T_STRING:
      return "text";
    case H5T_COMPOUND:
      return record_name(type);
    default:
      return "another type";
  }
}

Handle record_type(std::span<const Field> fields, std::size_t record_size) {
  Handle type(call(H5Tcreate, H5T_COMPOUND, record_size));
  for (const auto& field : fields) {
    const auto text = text_type(field.size);
    const hid_t member = field.type == "text"      ? text.id()
                         : field.type == "float64" ? native<double>()
                         : field.type == "uint64"  ? native<std::uint64_t>()
                         : field.type == "uint32"  ? native<std::uint32_t>()
                                                   : native<std::uint8_t>();
    call(H5Tinsert, type.id(), field.name.c_str(), field.offset, member);
  }
  return type;
}

Handle packed(const Handle& type) {
  Handle copy(call(H5Tcopy, type.id()));
  call(H5Tpack, copy.id());
  return copy;
}

std::vector<std::size_t> field_sizes(hid_t dataset) {
  const Handle type(call(H5Dget_type, dataset));
  std::vector<std::size_t> sizes(static_cast<std::size_t>(call(H5Tget_nmembers, type.id())));
  for (unsigned i = 0; i < sizes.size(); ++i) {
    sizes[i] = H5Tget_size(Handle(call(H5Tget_member_type, type.id(), i)).id());
  }
  return sizes;
}

Handle create_dataset(hid_t parent, const std::string& path, hid_t type, const DatasetOptions& options) {
  const auto creation = property_list(H5P_DATASET_CREATE);
  if (!options.contiguous) {
    Extent chunk = options.extent;
    for (auto& length : chunk) length = std::max<hsize_t>(length, 1);
    chunk.front() = std::max<hsize_t>(options.chunk_rows, 1);
    call(H5Pset_chunk, creation.id(), static_cast<int>(chunk.size()), chunk.data());
  }
  if (options.compressed) {
    constexpr unsigned hardest = 9;
    call(H5Pset_shuffle, creation.id());
    call(H5Pset_deflate, creation.id(), hardest);
  }
  if (options.fill != nullptr) call(H5Pset_fill_value, creation.id(), type, options.fill);
  return Handle(call(H5Dcreate2, parent, path.c_str(), type,
                     dataspace(options.extent, !options.contiguous).id(), utf8_names(H5P_LINK_CREATE).id(),
                     creation.id(), H5P_DEFAULT));
}

Description describe(hid_t dataset) {
  const Handle type(call(H5Dget_type, dataset));
  return {type_name(type.id()), extent_of(Handle(call(H5Dget_space, dataset)))};
}

namespace {

/// Values that lie in other files, by names that this one gives.
bool lies_elsewhere(hid_t dataset) {
  const Handle creation(call(H5Dget_create_plist, dataset));
  return H5Pget_layout(creation.id()) == H5D_VIRTUAL || call(H5Pget_external_count, creation.id()) > 0;
}

}  // namespace

bool is_plausible(hid_t dataset, std::uintmax_t file_size) {
  if (lies_elsewhere(dataset)) return false;
  std::uintmax_t bytes = H5Tget_size(Handle(call(H5Dget_type, dataset)).id());
  for (const hsize_t length : extent_of(Handle(call(H5Dget_space, dataset)))) {
    if (__builtin_mul_overflow(bytes, length, &bytes)) return false;
  }
  return bytes / max_deflated <= file_size;
}

void write(hid_t dataset, hid_t memory_type, const void* values) {
  call(H5Dwrite, dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
}

namespace {

/// Rows [first, first + rows) of a dataset, in the file and alone.
struct RowsOf {
  RowsOf(hid_t dataset, hsize_t rows, hsize_t first) : in_file(call(H5Dget_space, dataset)) {
    Extent extent = extent_of(in_file);
    extent.front() = rows;
    Extent start(extent.size(), 0);
    start.front() = first;
    call(H5Sselect_hyperslab, in_file.id(), H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr);
    alone = dataspace(extent, false);
  }
  Handle in_file;
  Handle alone;
};

}  // namespace

void write(hid_t dataset, hid_t memory_type, hsize_t rows, const void* values, hsize_t first) {
  const RowsOf part(dataset, rows, first);
  call(H5Dwrite, dataset, memory_type, part.alone.id(), part.in_file.id(), H5P_DEFAULT, values);
}

void append(hid_t dataset, hid_t memory_type, hsize_t rows_before, hsize_t rows, const void* values) {
  Extent extent = extent_of(Handle(call(H5Dget_space, dataset)));
  extent.front() = rows_before + rows;
  call(H5Dset_extent, dataset, extent.data());
  write(dataset, memory_type, rows, values, rows_before);
}

void flush(hid_t dataset) { call(H5Dflush, dataset); }

void read(hid_t dataset, hid_t memory_type, hsize_t rows, void* values, hsize_t first) {
  const RowsOf part(dataset, rows, first);
  call(H5Dread, dataset, memory_type, part.alone.id(), part.in_file.id(), H5P_DEFAULT, values);
}

namespace {

void put_attribute(hid_t object, const std::string& name, hid_t type, const Extent& extent,
                   const void* values) {
  const auto space = dataspace(extent, false);
  const Handle attribute(call(H5Acreate2, object, name.c_str(), type, space.id(),
                              utf8_names(H5P_ATTRIBUTE_CREATE).id(), H5P_DEFAULT));
  call(H5Awrite, attribute.id(), type, values);
}

}  // namespace

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const char* start = text.c_str();
  put_attribute(object, name, text_type(H5T_VARIABLE).id(), {}, &start);
}

void write_attribute(hid_t object, const std::string& name, std::span<const std::string> texts) {
  std::vector<const char*> starts;
  for (const auto& text : texts) starts.push_back(text.c_str());
  put_attribute(object, name, text_type(H5T_VARIABLE).id(), {starts.size()}, starts.data());
}

void write_attribute(hid_t object, const std::string& name, hid_t native_type, const Extent& extent,
                     const void* values) {
  put_attribute(object, name, native_type, extent, values);
}

void delete_attribute(hid_t object, const std::string& name) { call(H5Adelete, object, name.c_str()); }

bool has_attribute(hid_t object, const std::string& name) {
  return call(H5Aexists, object, name.c_str()) > 0;
}

std::vector<std::string> attributes(hid_t object) {
  std::vector<std::string> names;
  const H5A_operator2_t collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  call(H5Aiterate2, object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names);
  return names;
}

Description describe_attribute(hid_t object, const std::string& name) {
  const Handle attribute(call(H5Aopen, object, name.c_str(), H5P_DEFAULT));
  const Handle type(call(H5Aget_type, attribute.id()));
  return {type_name(type.id()), extent_of(Handle(call(H5Aget_space, attribute.id())))};
}

std::vector<std::string> read_texts(hid_t object, const std::string& name) {
  const Handle attribute(call(H5Aopen, object, name.c_str(), H5P_DEFAULT));
  const Handle space(call(H5Aget_space, attribute.id()));
  const Handle type(call(H5Aget_type, attribute.id()));
  const auto count = static_cast<std::size_t>(call(H5Sget_simple_extent_npoints, space.id()));
  std::vector<std::string> texts(count);
  if (count == 0) return texts;
  if (call(H5Tis_variable_str, type.id()) > 0) {
    std::vector<char*> starts(count, nullptr);
    call(H5Aread, attribute.id(), type.id(), static_cast<void*>(starts.data()));
    for (std::size_t i = 0; i < count; ++i) texts[i] = starts[i] == nullptr ? "" : starts[i];
    call(H5Dvlen_reclaim, type.id(), space.id(), H5P_DEFAULT, static_cast<void*>(starts.data()));
    return texts;
  }
  const std::size_t room = H5Tget_size(type.id());
  std::string bytes(count * room, '\0');
  call(H5Aread, attribute.id(), type.id(), bytes.data());
  for (std::size_t i = 0; i < count; ++i) {
    texts[i] = bytes.substr(i * room, room);
    texts[i].resize(std::min(texts[i].find('\0'), texts[i].size()));
  }
  return texts;
}

void read_attribute(hid_t object, const std::string& name, hid_t native_type, void* values) {
  const Handle attribute(call(H5Aopen, object, name.c_str(), H5P_DEFAULT));
  call(H5Aread, attribute.id(), native_type, values);
}

}  // namespace kerf::schema::h5
