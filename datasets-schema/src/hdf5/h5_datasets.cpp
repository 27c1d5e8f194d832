// Datasets: their extents, and rows in and out.
#include <algorithm>

#include "hdf5/h5.h"
#include "hdf5/h5_spaces.h"

namespace kerf::schema::h5 {

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
  if (options.timeless) call(H5Pset_obj_track_times, creation.id(), hbool_t{false});
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

}  // namespace kerf::schema::h5
