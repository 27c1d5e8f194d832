#include "run/shard_lock.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);  // opened anew each time: only then another machine's is seen
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The 22nd field of its line in /proc; empty: there is no such process.
std::string start_of(long process) {
  const std::string line = text_of(fmt::format("/proc/{}/stat", process));
  const auto name_end = line.rfind(')');
  if (name_end == std::string::npos) return "";
  std::istringstream fields(line.substr(name_end + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;
  return field;
}

std::string name_space() {
  std::error_code unknown;
  return fs::read_symlink("/proc/self/ns/pid", unknown).string();
}

LockHolder this_process() {
  std::array<char, 256> host{};
  (void)::gethostname(host.data(), host.size() - 1);
  LockHolder self{.host = host.data(), .process = ::getpid(), .started = start_of(::getpid())};
  std::istringstream(text_of("/proc/sys/kernel/random/boot_id")) >> self.boot;
  self.boot += "/" + name_space();
  const char* const job = std::getenv("SLURM_ARRAY_JOB_ID");
  const char* const task = std::getenv("SLURM_ARRAY_TASK_ID");
  if (job != nullptr && task != nullptr) self.job = fmt::format("{}_{}", job, task);
  return self;
}

[[noreturn]] void throw_of(const fs::path& file, const char* what) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{}: {}", file.string(), what));
}

bool same_inode(int descriptor, const fs::path& path) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

std::string LockHolder::as_text() const {
  return fmt::format("kerf.lock 1\nhost {}\nboot {}\nprocess {}\nstarted {}\njob {}\nbeat {:020}\n", host,
                     boot, process, started, job, beat);
}

LockHolder LockHolder::from_text(const std::string& text) {
  LockHolder holder;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const auto blank = line.find(' ');
    if (blank == std::string::npos) continue;
    const std::string key = line.substr(0, blank);
    const std::string value = line.substr(blank + 1);
    if (key == "host") holder.host = value;
    if (key == "boot") holder.boot = value;
    if (key == "process") holder.process = std::strtol(value.c_str(), nullptr, 10);
    if (key == "started") holder.started = value;
    if (key == "job") holder.job = value;
  }
  return holder;
}

std::string LockHolder::in_words() const {
  return fmt::format("process {} on {}{}", process, host, job.empty() ? "" : fmt::format(" (job {})", job));
}

fs::path ShardLock::path_of(fs::path place) {
  place += ".lock";
  return place;
}

LockHolder ShardLock::holder_of(const fs::path& place) {
  return LockHolder::from_text(text_of(path_of(place)));
}

ShardLock::ShardLock(const fs::path& place, const fs::path& guarded, Options options)
    : path_(path_of(place)), options_(std::move(options)), self_(this_process()) {
  // Made only by who has the lock: who is refused leaves no empty file beside a shard that has just ended.
  const bool guards = guard(guarded, Guarded::existing);
  while (!take()) {
    const std::string seen = text_of(path_);
    if (seen.empty()) continue;  // it went away meanwhile
    const LockHolder holder = LockHolder::from_text(seen);
    if (holder.boot == self_.boot) {
      if (start_of(holder.process) == holder.started) refuse(holder);
    } else {
      wait_until_stale(seen);
    }
    remove_stale(seen);
    options_.tell(fmt::format("{}: removed, {} left it behind", path_.string(), holder.in_words()));
  }
  try {
    if (!guards) (void)guard(guarded, Guarded::made);
  } catch (...) {
    give_back();
    throw;
  }
  last_beat_ = std::chrono::steady_clock::now();
}

ShardLock::~ShardLock() { give_back(); }

void ShardLock::give_back() const noexcept {
  if (is_ours()) (void)::unlink(path_.c_str());
}

/// @returns false if it is not there, and is not to be made.
bool ShardLock::guard(const fs::path& guarded, Guarded how) {
  const int flags = O_RDWR | O_CLOEXEC | (how == Guarded::made ? O_CREAT : 0);
  for (;;) {
    guard_ = processes::Descriptor(::open(guarded.c_str(), flags, 0666));
    if (guard_.number() < 0 && errno == ENOENT && how == Guarded::existing) return false;
    if (guard_.number() < 0) throw_of(guarded, "cannot be opened for writing");
    if (::flock(guard_.number(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      refuse(how == Guarded::made ? LockHolder{} : LockHolder::from_text(text_of(path_)));
    if (same_inode(guard_.number(), guarded)) return true;  // else it was given its final name meanwhile
  }
}

/// By a file of our own that is linked to the name: it is there with all that it says, or not at all.
bool ShardLock::take() {
  const fs::path own = fmt::format("{}.{}-{}", path_.string(), self_.host, self_.process);
  file_ = processes::Descriptor(::open(own.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (file_.number() < 0) throw_of(own, "cannot be opened for writing");
  const std::string text = self_.as_text();
  const bool written =
      ::pwrite(file_.number(), text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file_.number()) == 0;
  if (!written) {
    const int why = errno;
    (void)::unlink(own.c_str());
    errno = why;
    throw_of(own, "cannot be written");
  }
  const int failed = ::link(own.c_str(), path_.c_str()) == 0 ? 0 : errno;
  const bool taken = failed == 0 || same_inode(file_.number(), path_);  // an answer may be lost on its way
  (void)::unlink(own.c_str());
  if (!taken && failed != EEXIST) {
    errno = failed;
    throw_of(path_, "cannot be made");
  }
  return taken;
}

void ShardLock::wait_until_stale(const std::string& seen) {
  const LockHolder holder = LockHolder::from_text(seen);
  options_.tell(fmt::format("{}: {} has it; waiting {:.0f} s for a sign of life", path_.string(),
                            holder.in_words(), 1e-3 * static_cast<double>(options_.silence.count())));
  const auto end = std::chrono::steady_clock::now() + options_.silence;
  while (std::chrono::steady_clock::now() < end) {
    if (options_.stopped())
      throw std::system_error(std::make_error_code(std::errc::interrupted), path_.string());
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const std::string now = text_of(path_);
    if (now.empty()) return;
    if (now != seen) refuse(LockHolder::from_text(now));
  }
}

void ShardLock::remove_stale(const std::string& seen) const {
  const fs::path aside = fmt::format("{}.stale-{}-{}", path_.string(), self_.host, self_.process);
  if (::rename(path_.c_str(), aside.c_str()) != 0) {
    if (errno == ENOENT) return;
    throw_of(path_, "a lock that was left behind cannot be removed");
  }
  const std::string taken = text_of(aside);
  // Somebody else removed the stale one first, and this one is theirs: it gets its name back.
  if (taken != seen) (void)::link(aside.c_str(), path_.c_str());
  (void)::unlink(aside.c_str());
  if (taken != seen) refuse(LockHolder::from_text(taken));
}

void ShardLock::refuse(const LockHolder& holder) const {
  throw std::invalid_argument(fmt::format("{}: {} computes this shard; wait until it ends",
                                          fs::path(path_).replace_extension().string(),
                                          holder.host.empty() ? "another process" : holder.in_words()));
}

bool ShardLock::is_ours() const noexcept { return file_.number() >= 0 && same_inode(file_.number(), path_); }

void ShardLock::keep() {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_beat_ < options_.beat) return;
  last_beat_ = now;
  if (!is_ours())
    throw std::system_error(std::make_error_code(std::errc::no_lock_available),
                            fmt::format("{}: somebody else took this shard meanwhile", path_.string()));
  ++self_.beat;
  const std::string text = self_.as_text();
  if (::pwrite(file_.number(), text.data(), text.size(), 0) != static_cast<ssize_t>(text.size()) ||
      ::fsync(file_.number()) != 0)
    throw_of(path_, "cannot be written");
}

}  // namespace kerf::bench
