#include <cerrno>
#include <cstdio>
#include <string>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <kerf/schema/final_name.h>

#include "names/new_name.h"

namespace kerf::schema {
namespace {

constexpr mode_t as_umask_allows = 0666;
constexpr mode_t folder_as_umask_allows = 0777;

int errno_unless(bool succeeded) noexcept { return succeeded ? 0 : errno; }

int make_placeholder(const std::filesystem::path& name, bool folder) {
  if (folder) return errno_unless(::mkdir(name.c_str(), folder_as_umask_allows) == 0);
  const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, as_umask_allows);
  if (descriptor < 0) return errno;
  ::close(descriptor);
  return 0;
}

/// NAME-2, or the next number that nobody has: where a finished file is kept.
std::filesystem::path keep_beside(const std::filesystem::path& finished, const std::filesystem::path& name) {
  // Of NAME.law.toml the whole of ".law.toml" is the ending.
  const std::string file = name.filename().string();
  const std::size_t dot = is_folder(finished) ? std::string::npos : file.find('.', 1);
  const std::string stem = file.substr(0, dot);
  const std::string ending = dot == std::string::npos ? "" : file.substr(dot);
  for (int number = 2;; ++number) {
    auto beside = name.parent_path() / (stem + '-' + std::to_string(number) + ending);
    if (rename_new(finished, beside)) return beside;
  }
}

}  // namespace

NameTaken::NameTaken(const std::filesystem::path& name, std::filesystem::path kept)
    : std::system_error(EEXIST, std::generic_category(),
                        name.string() +
                            ": somebody has taken the name meanwhile; what was written is kept as " +
                            kept.string()),
      kept_(std::move(kept)) {}

bool is_folder(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

bool is_unknown(int error) noexcept {
  return error == EINVAL || error == ENOSYS || error == EOPNOTSUPP || error == EPERM || error == EMLINK;
}

int rename_exclusively(const std::filesystem::path& from, const std::filesystem::path& to) {
  return errno_unless(::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0);
}

int link_exclusively(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (is_folder(from)) return EPERM;
  const int failure = errno_unless(::link(from.c_str(), to.c_str()) == 0);
  return failure != 0 ? failure : errno_unless(::unlink(from.c_str()) == 0);
}

int replace_placeholder(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (const int failure = make_placeholder(to, is_folder(from)); failure != 0) return failure;
  return errno_unless(::rename(from.c_str(), to.c_str()) == 0);
}

bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to) {
  int failure = EINVAL;
  for (const auto way : {rename_exclusively, link_exclusively, replace_placeholder}) {
    if (is_unknown(failure)) failure = way(from, to);
  }
  if (failure != 0 && failure != EEXIST)
    throw std::system_error(failure, std::generic_category(),
                            to.string() + ": cannot give the file its name");
  return failure == 0;
}

void take_name(const std::filesystem::path& finished, const std::filesystem::path& name, Existing existing) {
  if (existing == Existing::replace) {
    std::error_code error;
    std::filesystem::rename(finished, name, error);
    if (error) throw std::system_error(error, name.string() + ": cannot give the file its name");
  } else if (!rename_new(finished, name)) {
    throw NameTaken(name, keep_beside(finished, name));
  }
}

}  // namespace kerf::schema
