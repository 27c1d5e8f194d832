#include "files.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::schema {
namespace {

[[noreturn]] void throw_errno(const std::filesystem::path& file, const std::string& doing) {
  throw std::system_error(errno, std::generic_category(), file.string() + ": cannot " + doing);
}

class Descriptor {
 public:
  explicit Descriptor(const std::filesystem::path& file)
      : number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
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

TemporaryFile::TemporaryFile(std::filesystem::path target) : target_(std::move(target)), path_(target_) {
  path_ += ".writing-" + std::to_string(::getpid());
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

void TemporaryFile::commit() {
  // What replaces a recording must not be lost with the power; a new file can be made again.
  if (std::filesystem::exists(target_)) synchronise(path_);
  rename_file(path_, target_);
  path_.clear();
}

void synchronise(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  if (::fsync(descriptor.number()) != 0) throw_errno(file, "write to the disk");
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) throw std::system_error(error, to.string() + ": cannot give the file its name");
}

std::system_error write_error(const std::filesystem::path& file, const h5::Error& error) {
  if (error.system_error != 0) {
    return std::system_error(error.system_error, std::generic_category(), file.string() + ": cannot write");
  }
  return std::system_error(EIO, std::generic_category(),
                           file.string() + ": cannot write (" + error.what() + ')');
}

void require_readable(const std::filesystem::path& file) {
  const Descriptor descriptor(file);
  struct stat status {};
  if (::fstat(descriptor.number(), &status) != 0) throw_errno(file, "read");
  if (S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    throw_errno(file, "read");
  }
}

}  // namespace kerf::schema
