#include <cerrno>
#include <map>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>

#include <kerf/schema/stand_in.h>

namespace kerf::schema {
namespace {

std::map<std::string, int>& descriptors() {
  static std::map<std::string, int> all;
  return all;
}

std::string key_of(const std::filesystem::path& file) {
  std::error_code unknown;
  const auto absolute = std::filesystem::absolute(file, unknown);
  return (unknown ? file : absolute).lexically_normal().string();
}

}  // namespace

void let_stand_in(const std::filesystem::path& file, const std::filesystem::path& recording) {
  const int descriptor = ::open(recording.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0)
    throw std::system_error(errno, std::generic_category(), recording.string() + ": cannot be read");
  descriptors()[key_of(file)] = descriptor;
}

int stand_in_of(const std::filesystem::path& file) {
  if (descriptors().empty()) return -1;
  const auto found = descriptors().find(key_of(file));
  return found == descriptors().end() ? -1 : found->second;
}

void require_no_stand_in(const std::filesystem::path& file) {
  if (stand_in_of(file) >= 0)
    throw std::invalid_argument(file.string() +
                                ": a text stays as it is, and this would be written into its recording; run "
                                "'kerf import' first, and name the recording that it writes");
}

}  // namespace kerf::schema
