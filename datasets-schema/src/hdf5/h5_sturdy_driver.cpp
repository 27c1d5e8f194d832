// HDF5 crashes when it closes a file whose data it could not write (a full disk, a pulled cable). This file
// driver stands between it and the disk: after the first write that fails it drops all others and tells HDF5
// that all is well, so that everything is closed in order and the file keeps what was written before. The
// failure is kept where WritableFile finds it.
#include <cerrno>
#include <limits>
#include <new>

#include "hdf5/h5.h"

namespace kerf::schema::h5 {
namespace {

constexpr haddr_t greatest_address = std::numeric_limits<std::int64_t>::max();

struct Settings {
  int* failure;  ///< errno of the first write that failed
};

struct SturdyFile {
  H5FD_t public_part;  // First, as HDF5 takes the whole for it.
  H5FD_t* disk;
  int* failure;
};

SturdyFile* sturdy(H5FD_t* file) { return reinterpret_cast<SturdyFile*>(file); }
const SturdyFile* sturdy(const H5FD_t* file) { return reinterpret_cast<const SturdyFile*>(file); }

/// Does what changes the file, unless something failed before.
template <typename Action>
herr_t unless_failed(H5FD_t* file, Action action) {
  int& failure = *sturdy(file)->failure;
  if (failure != 0) return 0;
  errno = 0;
  if (action(sturdy(file)->disk) < 0) failure = errno != 0 ? errno : EIO;
  return 0;
}

H5FD_t* open(const char* name, unsigned flags, hid_t access, haddr_t /*most*/) {
  const auto* settings = static_cast<const Settings*>(H5Pget_driver_info(access));
  auto* file = new (std::nothrow) SturdyFile{};
  if (file == nullptr) return nullptr;
  file->failure = settings->failure;
  file->disk = H5FDopen(name, flags, H5P_DEFAULT, greatest_address);
  if (file->disk == nullptr) {
    delete file;
    return nullptr;
  }
  return &file->public_part;
}

herr_t close(H5FD_t* file) {
  const herr_t result = H5FDclose(sturdy(file)->disk);
  delete sturdy(file);
  return result;
}

int compare(const H5FD_t* a, const H5FD_t* b) { return H5FDcmp(sturdy(a)->disk, sturdy(b)->disk); }

herr_t query(const H5FD_t* file, unsigned long* flags) {
  return file == nullptr ? H5FDdriver_query(H5FD_SEC2, flags) : H5FDquery(sturdy(file)->disk, flags);
}

haddr_t end_of_addresses(const H5FD_t* file, H5FD_mem_t type) {
  return H5FDget_eoa(sturdy(file)->disk, type);
}

herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t type, haddr_t address) {
  return H5FDset_eoa(sturdy(file)->disk, type, address);
}

haddr_t end_of_file(const H5FD_t* file, H5FD_mem_t type) { return H5FDget_eof(sturdy(file)->disk, type); }

herr_t handle(H5FD_t* file, hid_t access, void** result) {
  return H5FDget_vfd_handle(sturdy(file)->disk, access, result);
}

herr_t read(H5FD_t* file, H5FD_mem_t type, hid_t transfer, haddr_t address, std::size_t size, void* bytes) {
  return H5FDread(sturdy(file)->disk, type, transfer, address, size, bytes);
}

herr_t write(H5FD_t* file, H5FD_mem_t type, hid_t transfer, haddr_t address, std::size_t size,
             const void* bytes) {
  return unless_failed(file,
                       [&](H5FD_t* disk) { return H5FDwrite(disk, type, transfer, address, size, bytes); });
}

herr_t truncate(H5FD_t* file, hid_t transfer, hbool_t closing) {
  return unless_failed(file, [&](H5FD_t* disk) { return H5FDtruncate(disk, transfer, closing); });
}

herr_t lock(H5FD_t* file, hbool_t exclusive) { return H5FDlock(sturdy(file)->disk, exclusive); }

herr_t unlock(H5FD_t* file) { return H5FDunlock(sturdy(file)->disk); }

hid_t register_driver() {
  H5FD_class_t driver{};
  driver.name = "sturdy";
  driver.maxaddr = greatest_address;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(Settings);
  driver.open = &open;
  driver.close = &close;
  driver.cmp = &compare;
  driver.query = &query;
  driver.get_eoa = &end_of_addresses;
  driver.set_eoa = &set_end_of_addresses;
  driver.get_eof = &end_of_file;
  driver.get_handle = &handle;
  driver.read = &read;
  driver.write = &write;
  driver.truncate = &truncate;
  driver.lock = &lock;
  driver.unlock = &unlock;
  constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  for (std::size_t i = 0; i < H5FD_MEM_NTYPES; ++i) driver.fl_map[i] = map[i];
  return call(H5FDregister, &driver);
}

}  // namespace

Handle sturdy_access(int& failure) {
  static const hid_t driver = register_driver();
  Handle access(call(H5Pcreate, H5P_FILE_ACCESS));
  const Settings settings{&failure};
  call(H5Pset_driver, access.id(), driver, &settings);
  // Nobody else writes the file: what cannot be read back at once was dropped, and waiting does not bring it.
  call(H5Pset_metadata_read_attempts, access.id(), 1U);
  return access;
}

}  // namespace kerf::schema::h5
