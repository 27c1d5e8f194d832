#include "hdf5/h5.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <thread>

#include "hdf5/h5_spaces.h"

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

Handle property_list(hid_t kind) { return Handle(call(H5Pcreate, kind)); }

Handle utf8_names(hid_t kind) {
  auto properties = property_list(kind);
  call(H5Pset_char_encoding, properties.id(), H5T_CSET_UTF8);
  return properties;
}

WritableFile WritableFile::create(const std::filesystem::path& file, Format format) {
  auto failure = std::make_unique<int>(0);
  const auto access = sturdy_access(*failure);
  const auto version = format == Format::live_readers ? H5F_LIBVER_V110 : H5F_LIBVER_V18;
  call(H5Pset_libver_bounds, access.id(), version, version);
  const auto creation = property_list(H5P_FILE_CREATE);
  if (format == Format::timeless) call(H5Pset_obj_track_times, creation.id(), hbool_t{false});
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

namespace {

/// A file that is open somewhere and has no name any more: the usual driver asks for one, that of stdio does
/// not.
Handle open_nameless(const std::filesystem::path& file) {
  const auto access = property_list(H5P_FILE_ACCESS);
  call(H5Pset_fapl_stdio, access.id());
  return Handle(call(H5Fopen, file.c_str(), H5F_ACC_RDONLY, access.id()));
}

}  // namespace

Handle open_file(const std::filesystem::path& file) {
  try {
    return Handle(call(H5Fopen, file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  } catch (const Error& error) {
    const std::string_view why(error.what());
    if (why.find("can't retrieve real path") != std::string_view::npos) return open_nameless(file);
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

Handle create_group(hid_t parent, const std::string& path, bool timeless) {
  const auto creation = property_list(H5P_GROUP_CREATE);
  if (timeless) call(H5Pset_obj_track_times, creation.id(), hbool_t{false});
  call(H5Pset_link_creation_order, creation.id(), 0U | H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  return Handle(
      call(H5Gcreate2, parent, path.c_str(), utf8_names(H5P_LINK_CREATE).id(), creation.id(), H5P_DEFAULT));
}

Handle open(hid_t parent, const std::string& path) {
  return Handle(call(H5Oopen, parent, path.c_str(), H5P_DEFAULT));
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

}  // namespace kerf::schema::h5
