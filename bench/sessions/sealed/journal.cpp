#include "sealed/journal.h"

#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sealed/blake2b.h"
#include "sealed/bytes.h"
#include "sealed/journal_format.h"

namespace kerf::bench {
namespace {

using namespace journal_format;
using Bytes = std::span<const std::uint8_t>;

[[noreturn]] void throw_errno(const std::filesystem::path& file, const char* doing) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{}: cannot {}", file.string(), doing));
}

/// A lock of the open file description: it goes with the process, and others can ask for it without taking
/// it.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

/// Whether the name still leads to the open file.
bool is_still_named(const std::filesystem::path& file, int descriptor) {
  struct stat opened {};
  struct stat named {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

std::string runner(int descriptor) {
  std::array<std::uint8_t, 8> bytes{};
  if (::pread(descriptor, bytes.data(), bytes.size(), pid_at) != static_cast<ssize_t>(bytes.size()))
    return {};
  return fmt::format(" (pid {})", ByteReader(bytes).number<std::uint64_t>());
}

}  // namespace

std::filesystem::path journal_of(const std::filesystem::path& session) {
  std::filesystem::path file = session;
  file += ".journal";
  return file;
}

void bring_to_disk(const std::filesystem::path& path) {
  const int descriptor = ::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw_errno(path, "open");
  const int result = ::fsync(descriptor);
  const int reason = errno;
  ::close(descriptor);
  errno = reason;
  // Some file systems know no folders on the disk: they refuse with EINVAL.
  if (result != 0 && reason != EINVAL) throw_errno(path, "write to the disk");
}

Journal::Journal(std::filesystem::path session, int descriptor)
    : session_(std::move(session)), file_(journal_of(session_)), descriptor_(descriptor) {}

Journal::Journal(Journal&& other) noexcept
    : session_(std::move(other.session_)),
      file_(std::move(other.file_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      may_write_(other.may_write_),
      being_run_(other.being_run_),
      end_(other.end_),
      entries_(std::move(other.entries_)),
      places_(std::move(other.places_)),
      warnings_(std::move(other.warnings_)) {}

Journal::~Journal() {
  if (descriptor_ < 0) return;
  // Nothing was written, or nothing but the head: no reason to leave a file behind.
  struct stat status {};
  if (may_write_ && ::fstat(descriptor_, &status) == 0 && status.st_size <= static_cast<off_t>(head_size) &&
      is_still_named(file_, descriptor_)) {
    ::unlink(file_.c_str());
  }
  ::close(descriptor_);
}

// Two runs never go on at once, nor does one lose its entries to the end of another:
// - whoever has the lock reads FILE only afterwards, so it sees all that those before it have put there;
// - whoever ends a run renames the new FILE first and takes the journal's name away last, both under the
// lock;
// - whoever opened the journal before that, and got the lock after it, has a file without a name, into which
//   nothing may be written: hence the question whether the name still leads there. It then begins anew.
Journal Journal::lock(const std::filesystem::path& session) {
  const std::filesystem::path file = journal_of(session);
  for (;;) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0) throw_errno(file, "open");
    Journal journal(session, descriptor);
    struct flock lock = whole_file();
    if (::fcntl(descriptor, F_OFD_SETLK, &lock) != 0) {
      if (errno != EAGAIN && errno != EACCES) throw_errno(file, "lock");
      throw std::invalid_argument(
          fmt::format("{}: is being run by another process{}; wait for its end, or end it first",
                      session.string(), runner(descriptor)));
    }
    journal.may_write_ = true;
    if (is_still_named(file, descriptor)) return journal;
  }
}

std::optional<Journal> Journal::look(const std::filesystem::path& session) {
  const std::filesystem::path file = journal_of(session);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0 && errno == ENOENT) return std::nullopt;
  if (descriptor < 0) throw_errno(file, "open");
  Journal journal(session, descriptor);
  journal.ask_whether_run();
  return journal;
}

void Journal::ask_whether_run() {
  struct flock lock = whole_file();
  being_run_ = ::fcntl(descriptor_, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

std::uint64_t Journal::size() const {
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) throw_errno(file_, "read");
  return static_cast<std::uint64_t>(status.st_size);
}

std::vector<std::uint8_t> Journal::read(std::uint64_t at, std::uint64_t bytes) const {
  std::vector<std::uint8_t> content(bytes);
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t count =
        ::pread(descriptor_, content.data() + done, bytes - done, static_cast<off_t>(at + done));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_errno(file_, "read");
    if (count == 0) break;  // another process cut it off meanwhile
    done += static_cast<std::size_t>(count);
  }
  content.resize(done);
  return content;
}

void Journal::write(std::uint64_t at, Bytes bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_errno(file_, "write");
    bytes = bytes.subspan(static_cast<std::size_t>(count));
    at += static_cast<std::uint64_t>(count);
  }
}

bool Journal::has_records() const { return size() > head_size; }

std::vector<std::uint8_t> Journal::read_sealed(std::size_t entry) const {
  const Place& place = places_.at(entry);
  return read(place.at, place.bytes);
}

void Journal::cut_off() {
  if (::ftruncate(descriptor_, static_cast<off_t>(end_)) != 0) throw_errno(file_, "write");
}

void Journal::flush() const {
  if (::fdatasync(descriptor_) != 0) throw_errno(file_, "write to the disk");
}

void Journal::append(const schema::SessionEntry& entry) {
  ByteWriter texts;
  texts.text(entry.kind);
  texts.text(entry.time);
  texts.text(entry.text);
  const std::uint64_t length = texts.written().size() + entry.sealed.size();
  ByteWriter record;
  record.bytes(as_bytes(record_mark));
  record.number(length);
  record.bytes(check_of(blake2b({texts.written(), entry.sealed})));
  record.bytes(check_of(blake2b({record.written()})));
  record.bytes(texts.written());
  const std::uint64_t sealed_at = end_ + record.written().size();
  try {
    cut_off();  // what a crash or an earlier failure left
    write(end_, record.written());
    write(sealed_at, entry.sealed);
    flush();
  } catch (const std::system_error&) {
    static_cast<void>(::ftruncate(descriptor_, static_cast<off_t>(end_)));
    throw;
  }
  entries_.push_back({.kind = entry.kind, .time = entry.time, .text = entry.text, .sealed = {}});
  places_.push_back({.at = sealed_at, .bytes = entry.sealed.size()});
  end_ = sealed_at + entry.sealed.size();
}

void Journal::remove() {
  if (::unlink(file_.c_str()) != 0 && errno != ENOENT) throw_errno(file_, "remove");
}

}  // namespace kerf::bench
