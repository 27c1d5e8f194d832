#include "run/sweep_worker.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kerf::bench {

SweepWorker::SweepWorker(const WorkerProgram& program, const std::filesystem::path& plan) {
  processes::Connection ends = processes::connection(SOCK_STREAM);
  std::vector<std::string> words{"sweep", "worker", plan.string()};
  for (const std::string& plugin : program.plugins) words.insert(words.end(), {"--plugin", plugin});
  const std::filesystem::path file =
      program.program.empty() ? "/proc/self/exe" : program.program;  // also where it was replaced meanwhile
  const std::array<int, 1> given{ends.theirs.number()};
  const int error = ends.ours.number() < 0 ? errno : processes::start(file, given, process_, words);
  if (error != 0)
    throw std::system_error(error, std::generic_category(),
                            fmt::format("{}: a worker cannot be started", file.string()));
  connection_ = std::move(ends.ours);
}

SweepWorker::~SweepWorker() {
  if (process_ > 0) (void)end();
}

bool SweepWorker::order(const CellOrder& cells) {
  if (orders_.empty()) since_ = Clock::now();
  const auto sent = ::send(connection_.number(), &cells, sizeof cells, MSG_NOSIGNAL);
  if (sent != static_cast<ssize_t>(sizeof cells)) return false;
  orders_.push_back(cells);
  ordered_ += cells.end - cells.begin;
  return true;
}

void SweepWorker::answered(std::uint64_t cell) {
  if (orders_.empty() || orders_.front().begin != cell)
    throw std::runtime_error(fmt::format("a worker answered cell {}, which was not its turn", cell));
  if (++orders_.front().begin == orders_.front().end) orders_.pop_front();
  --ordered_;
  since_ = Clock::now();
}

bool SweepWorker::receive(const std::function<void(const CellRecord&, std::string_view)>& take) {
  std::array<char, 65536> bytes{};
  const auto count = ::recv(connection_.number(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return true;
  if (count <= 0) return false;
  received_.append(bytes.data(), static_cast<std::size_t>(count));
  std::string_view left = received_;
  while (const auto frame = first_frame(left)) {
    const CellRecord& record = frame->record;
    if (const auto* const computed = std::get_if<ComputedCell>(&record)) answered(computed->cell);
    if (const auto* const failed = std::get_if<FailedCell>(&record)) answered(failed->cell);
    if (std::holds_alternative<HeadRecord>(record)) {
      ready_ = true;
      since_ = Clock::now();
    }
    take(record, left.substr(0, frame->size));
    left.remove_prefix(frame->size);
  }
  received_.erase(0, received_.size() - left.size());
  return true;
}

std::string SweepWorker::end() {
  connection_.reset();
  // What ended by itself is waited for, which tells how.
  (void)::kill(process_, SIGKILL);
  const int status = processes::wait_for(process_);
  process_ = -1;
  if (WIFSIGNALED(status))
    return fmt::format("ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("ended with exit status {}", WEXITSTATUS(status));
}

}  // namespace kerf::bench
