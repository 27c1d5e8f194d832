#include "convert/output_file.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace kerf::bench {

UnfinishedFile::UnfinishedFile(std::filesystem::path name)
    : name_(std::move(name)), path_(schema::unfinished_name(name_)) {
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) fail(errno);
  ::close(file);
  mark_ = schema::WriteMark(path_);
}

UnfinishedFile::~UnfinishedFile() {
  std::error_code ignored;
  if (!is_committed_) std::filesystem::remove(path_, ignored);
}

void UnfinishedFile::commit(schema::Existing existing) {
  try {
    schema::take_name(path_, name_, existing);
  } catch (const schema::NameTaken&) {
    is_committed_ = true;  // it is kept under another name
    throw;
  }
  is_committed_ = true;
}

void UnfinishedFile::fail(int reason) const {
  throw std::system_error(reason != 0 ? reason : EIO, std::generic_category(),
                          "cannot write " + name_.string());
}

OutputFile::OutputFile(const std::filesystem::path& name)
    : file_(name), stream_(std::fopen(file_.path().c_str(), "wbe")) {
  if (stream_ == nullptr) file_.fail(errno);
}

OutputFile::~OutputFile() {
  if (stream_ != nullptr) static_cast<void>(std::fclose(stream_));
}

void OutputFile::write(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) file_.fail(errno);
  size_ += bytes.size();
}

void OutputFile::close() {
  errno = 0;
  if (std::fclose(std::exchange(stream_, nullptr)) != 0) file_.fail(errno);
}

}  // namespace kerf::bench
