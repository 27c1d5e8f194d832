#include "apart/reader_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/schema/stand_in.h>
#include <kerf/schema/validate.h>

#include "hdf5/files.h"

namespace kerf::schema::apart {
namespace {

/// As long as the slowest disk takes to give the whole file, and a minute.
int patience_ms(std::uintmax_t file_bytes) {
  constexpr std::uintmax_t slow_bytes_per_ms = 5000;
  constexpr std::uintmax_t minute_ms = 60'000;
  constexpr std::uintmax_t day_ms = 24 * 60 * minute_ms;
  return static_cast<int>(minute_ms + std::min(file_bytes / slow_bytes_per_ms, day_ms));
}

[[noreturn]] void refuse_start(const std::filesystem::path& file, const std::filesystem::path& reader,
                               int error) {
  throw std::system_error(error, std::generic_category(),
                          file.string() + ": cannot be read: " + reader.string() +
                              ", which reads it, does not start; install or build it there");
}

processes::Descriptor opened(const std::filesystem::path& file, std::string_view expected) {
  if (const int other = stand_in_of(file); other >= 0)
    return processes::Descriptor(::fcntl(other, F_DUPFD_CLOEXEC, 0));
  require_readable(file, expected);
  processes::Descriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (descriptor.number() < 0) {
    throw std::system_error(errno, std::generic_category(), file.string() + ": cannot be read");
  }
  return descriptor;
}

/// Memory that both see, and that no reader can take away from under us.
processes::Descriptor new_window() {
  processes::Descriptor window(::memfd_create("kerf-reader", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (window.number() >= 0 &&
      (::ftruncate(window.number(), window_bytes) != 0 ||
       ::fcntl(window.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)) {
    window.reset();
  }
  return window;
}

}  // namespace

ReaderProcess::ReaderProcess(const std::filesystem::path& file, std::string_view expected) : file_(file) {
  const auto reader = processes::helper_program("kerf-reader");
  const auto descriptor = opened(file, expected);
  struct stat status {};
  if (::fstat(descriptor.number(), &status) != 0) refuse_start(file, reader, errno);
  const auto file_bytes = static_cast<std::uintmax_t>(status.st_size);
  max_bytes_ = h5::max_deflated * file_bytes;
  usual_timeout_ms_ = patience_ms(file_bytes);
  set_timeout(std::nullopt);
  const auto window = new_window();
  auto [ours, theirs] = processes::connection(SOCK_SEQPACKET);
  if (window.number() < 0 || ours.number() < 0) refuse_start(file, reader, errno);
  void* const mapped = ::mmap(nullptr, window_bytes, PROT_READ, MAP_SHARED, window.number(), 0);
  if (mapped == MAP_FAILED) refuse_start(file, reader, errno);
  window_ = static_cast<std::byte*>(mapped);
  socket_ = std::move(ours);
  const std::array descriptors{descriptor.number(), theirs.number(), window.number()};
  if (const int error = processes::start(reader, descriptors, process_); error != 0) {
    ::munmap(window_, window_bytes);
    refuse_start(file, reader, error);
  }
}

ReaderProcess::~ReaderProcess() {
  // It has nothing to lose, and may be anywhere in HDF5.
  if (process_ > 0) {
    static_cast<void>(::kill(process_, SIGKILL));
    processes::wait_for(process_);
  }
  ::munmap(window_, window_bytes);
}

void ReaderProcess::begin(const Request& request) {
  if (process_ == 0) throw DamageError(file_, "its reader has fallen over before");
  is_last_ = false;
  if (::send(socket_.number(), &request, sizeof request, MSG_NOSIGNAL) != sizeof request) {
    give_up(how_it_ended());
  }
}

void ReaderProcess::end() {
  while (!is_last_ && piece_.empty()) next_piece();
  if (!piece_.empty()) give_up("its reader says more than it was asked for");
}

void ReaderProcess::get(void* to, std::size_t bytes) {
  auto* at = static_cast<std::byte*>(to);
  while (bytes > 0) {
    if (piece_.empty()) {
      if (is_last_) give_up("its reader says less than it was asked for");
      next_piece();
      continue;
    }
    const std::size_t now = std::min(bytes, piece_.size());
    std::memcpy(at, piece_.data(), now);
    at += now;
    bytes -= now;
    piece_ = piece_.subspan(now);
    if (piece_.empty()) copied();
  }
}

in_process::RecordingFacts ReaderProcess::get_facts() {
  in_process::RecordingFacts facts;
  ValueReader(*this).read(facts);
  const std::size_t dimensions = facts.about.dimensions();
  bool is_sound = dimensions >= 1 && dimensions <= max_axes && facts.rows <= max_bytes_;
  for (std::size_t dataset = 0; dataset < facts.widths.size(); ++dataset) {
    const std::size_t width = in_process::is_per_axis(dataset) ? dimensions : 1;
    const bool may_lack = !in_process::is_required(dataset);
    is_sound = is_sound && (facts.widths[dataset] == width || (may_lack && facts.widths[dataset] == 0));
  }
  if (!is_sound) give_up("its reader says what does not go together");
  return facts;
}

void ReaderProcess::next_piece() {
  if (!processes::becomes_readable(socket_.number(), timeout_ms_)) {
    give_up("reading it takes longer than " + std::to_string(timeout_ms_ / 1000) + " s");
  }
  Piece piece;
  const auto got = ::recv(socket_.number(), &piece, sizeof piece, MSG_DONTWAIT);
  if (got == 0 || (got < 0 && errno == ECONNRESET)) give_up(how_it_ended());
  if (got != sizeof piece || piece.bytes > half_bytes) give_up("its reader says what makes no sense");
  piece_ = std::span(window_ + half_ * half_bytes, piece.bytes);
  half_ = 1 - half_;
  is_last_ = piece.kind != Kind::more;
  if (piece.kind != Kind::more && piece.kind != Kind::last) refuse_as_it_does(piece.kind, piece.error_number);
  if (piece_.empty()) copied();
}

void ReaderProcess::copied() {
  // Where it has ended, the next piece says so.
  static_cast<void>(::send(socket_.number(), &piece_is_copied, sizeof piece_is_copied, MSG_NOSIGNAL));
}

/// It knows the file by its descriptor alone.
std::string ReaderProcess::in_our_words(std::string text) const {
  const std::string theirs = "/proc/self/fd/" + std::to_string(reader_of_file);
  const std::string ours = file_.string();
  for (auto at = text.find(theirs); at != std::string::npos; at = text.find(theirs, at + ours.size())) {
    text.replace(at, theirs.size(), ours);
  }
  return one_line(std::move(text));
}

std::string ReaderProcess::text_of_piece() const {
  return in_our_words({reinterpret_cast<const char*>(piece_.data()), piece_.size()});
}

void ReaderProcess::refuse_as_it_does(Kind kind, int error_number) {
  const std::string text = text_of_piece();
  piece_ = {};
  copied();
  if (kind == Kind::damage) throw DamageError(file_, text);
  if (kind == Kind::system_error) throw std::system_error(error_number, std::generic_category(), text);
  throw FormatError(text);
}

void ReaderProcess::give_up(const std::string& why) {
  if (process_ > 0) {
    static_cast<void>(::kill(process_, SIGKILL));
    processes::wait_for(std::exchange(process_, 0));
  }
  piece_ = {};
  is_last_ = true;
  throw DamageError(file_, why);
}

std::string ReaderProcess::how_it_ended() {
  if (process_ == 0) return "its reader has fallen over before";
  const int status = processes::wait_for(std::exchange(process_, 0));
  if (!WIFSIGNALED(status)) return "its reader ended with " + std::to_string(WEXITSTATUS(status));
  return "HDF5 fell over: " + std::string(::strsignal(WTERMSIG(status)));
}

}  // namespace kerf::schema::apart
