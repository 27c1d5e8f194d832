#include "hdf5/files.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <kerf/schema/recording.h>
#include <kerf/schema/stand_in.h>

namespace kerf::schema {
namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& file, const std::string& doing) {
  throw std::system_error(errno, std::generic_category(), file.string() + ": cannot " + doing);
}

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file, int access = O_RDONLY)
      : number_(::open(file.c_str(), access | O_CLOEXEC)) {
    if (number_ < 0) throw_errno(file, "open");
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { ::close(number_); }
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

}  // namespace

TemporaryFile::TemporaryFile(std::filesystem::path target)
    : target_(std::move(target)), path_(unfinished_name(target_)) {
  require_no_stand_in(target_);
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);  // of a process of the same number that was killed here
}

h5::WritableFile TemporaryFile::create(h5::WritableFile::Format format) {
  auto file = h5::WritableFile::create(path_, format);
  mark_ = WriteMark(path_);
  return file;
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

void TemporaryFile::commit(Existing existing) {
  // What replaces a recording must not be lost with the power; a new file can be made again.
  if (std::filesystem::exists(target_)) synchronise(path_);
  try {
    take_name(path_, target_, existing);
    path_.clear();
  } catch (const NameTaken&) {
    path_.clear();  // it is kept under another name
    throw;
  }
}

std::filesystem::path partial_name(std::filesystem::path file) {
  file += ".partial";
  return file;
}

void reserve(const std::filesystem::path& file, std::size_t bytes) {
  const Descriptor descriptor(file, O_WRONLY);
  const auto end = static_cast<off_t>(std::filesystem::file_size(file));
  errno = ::posix_fallocate(descriptor.number(), end, static_cast<off_t>(bytes));
  if (errno != 0) throw_errno(file, "write");
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

void synchronise(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  // EINVAL: of a file system that cannot be asked to.
  if (::fsync(descriptor.number()) != 0 && errno != EINVAL) throw_errno(file, "write to the disk");
}

void synchronise_data(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  if (::fdatasync(descriptor.number()) != 0) throw_errno(file, "write to the disk");
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  return text;
}

std::system_error write_error(const std::filesystem::path& file, const h5::Error& error) {
  if (error.system_error != 0) {
    return std::system_error(error.system_error, std::generic_category(), file.string() + ": cannot write");
  }
  return std::system_error(EIO, std::generic_category(),
                           file.string() + ": cannot write (" + error.what() + ')');
}

void require_hdf5(const std::filesystem::path& file, std::string_view expected) {
  if (!h5::is_hdf5(file)) {
    throw FormatError(file.string() + ": not an HDF5 file; expected " + std::string(expected));
  }
}

void require_readable(const std::filesystem::path& file, std::string_view expected) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    const auto partial = partial_name(file);
    if (!std::filesystem::exists(partial, ignored)) {
      throw std::invalid_argument(file.string() + ": there is no such file; expected " +
                                  std::string(expected));
    }
    throw std::invalid_argument(file.string() + ": there is no such file; " + partial.string() +
                                (is_marked(partial)
                                     ? " is still written; 'kerf info --follow' shows it"
                                     : " holds a recording that was not closed; 'kerf repair' closes it"));
  }
  if (!std::filesystem::is_regular_file(file, ignored)) {
    throw std::invalid_argument(file.string() + ": not a file; expected " + std::string(expected));
  }
  if (::access(file.c_str(), R_OK) != 0)
    throw std::invalid_argument(file.string() + ": cannot be read: " + std::strerror(errno));
}

}  // namespace kerf::schema
