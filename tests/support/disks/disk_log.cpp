#include "support/disks/disk_log.h"

#include <array>
#include <mutex>
#include <string>

#include <sys/syscall.h>
#include <unistd.h>

namespace kerf::test {
namespace {

struct State {
  std::mutex mutex;
  std::string folder;  ///< empty: nobody asks
  std::vector<DiskCall> calls;
};

State& state() {
  static State state;
  return state;
}

std::string name_of(int descriptor) {
  std::array<char, 4096> name{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), name.data(), name.size());
  return {name.data(), length > 0 ? static_cast<std::size_t>(length) : 0};
}

void keep(const std::string& name, DiskCall call) {
  const std::lock_guard lock(state().mutex);
  const std::string& folder = state().folder;
  if (folder.empty() || !name.starts_with(folder)) return;
  if (call.kind == DiskCall::Kind::synchronise && name == folder)
    call.kind = DiskCall::Kind::synchronise_names;
  state().calls.push_back(std::move(call));
}

}  // namespace

DiskLog::DiskLog(const std::filesystem::path& folder) {
  const std::lock_guard lock(state().mutex);
  state().folder = std::filesystem::canonical(folder).string();
  state().calls.clear();
}

DiskLog::~DiskLog() {
  const std::lock_guard lock(state().mutex);
  state().folder.clear();
}

const std::vector<DiskCall>& DiskLog::calls() const { return state().calls; }

}  // namespace kerf::test

// In the place of the C library's. A call is kept once it has been done.
using kerf::test::DiskCall;

extern "C" {

ssize_t pwrite64(int descriptor, const void* bytes, size_t size, off64_t at) {
  const ssize_t written = syscall(SYS_pwrite64, descriptor, bytes, size, at);
  const auto* first = static_cast<const char*>(bytes);
  if (written > 0)
    kerf::test::keep(kerf::test::name_of(descriptor),
                     {.kind = DiskCall::Kind::write, .at = at, .bytes = {first, first + written}});
  return written;
}

ssize_t pwrite(int descriptor, const void* bytes, size_t size, off_t at) {
  return pwrite64(descriptor, bytes, size, at);
}

int ftruncate64(int descriptor, off64_t size) noexcept {
  const auto result = static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
  if (result == 0)
    kerf::test::keep(kerf::test::name_of(descriptor), {.kind = DiskCall::Kind::resize, .at = size});
  return result;
}

int ftruncate(int descriptor, off_t size) noexcept { return ftruncate64(descriptor, size); }

int fsync(int descriptor) {
  const auto result = static_cast<int>(syscall(SYS_fsync, descriptor));
  if (result == 0) kerf::test::keep(kerf::test::name_of(descriptor), {.kind = DiskCall::Kind::synchronise});
  return result;
}

int fdatasync(int descriptor) {
  const auto result = static_cast<int>(syscall(SYS_fdatasync, descriptor));
  if (result == 0) kerf::test::keep(kerf::test::name_of(descriptor), {.kind = DiskCall::Kind::synchronise});
  return result;
}

int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  const auto result = static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
  if (result == 0) kerf::test::keep(to, {.kind = DiskCall::Kind::rename});
  return result;
}
}
