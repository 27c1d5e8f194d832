#include "regress/renderers/run_program.h"

#include <array>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>
#include <poll.h>

#include "regress/renderers/child_program.h"

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int look_every_ms = 10;  ///< at the size of what it writes

bool too_large(const ProgramRun& run) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(run.output, none);
  return !none && size > run.output_at_most;
}

/// Why it has to be killed; empty: it ended.
std::string watch(const ProgramRun& run, ChildProgram& program) {
  const auto deadline = Clock::now() + run.timeout;
  std::array<pollfd, 3> waited{
      {{.fd = program.ended(), .events = POLLIN, .revents = 0},
       {.fd = program.output.pipe().reads.number(), .events = POLLIN, .revents = 0},
       {.fd = program.errors.pipe().reads.number(), .events = POLLIN, .revents = 0}}};
  for (;;) {
    poll(waited.data(), waited.size(), look_every_ms);
    if (waited[1].revents != 0 && !program.output.take()) waited[1].fd = -1;
    if (waited[2].revents != 0 && !program.errors.take()) waited[2].fd = -1;
    if (too_large(run)) {
      return fmt::format(
          "the renderer wrote more than {} bytes of forces, more than its rows can take, and was killed",
          run.output_at_most);
    }
    if (waited[0].revents != 0) return {};
    if (Clock::now() > deadline) {
      return fmt::format("the renderer had not ended after {:g} s and was killed with its process group",
                         run.timeout.count());
    }
  }
}

}  // namespace

ProgramWords run_program(const ProgramRun& run) {
  ChildProgram program({.command = run.command, .folder = run.folder});
  const std::string why = watch(run, program);
  const int status = program.kill_group();
  if (!why.empty()) throw std::invalid_argument(why + program.last_words());
  if (status != 0) {
    const std::string end = end_in_words(status);
    throw std::invalid_argument(fmt::format(
        "the renderer {}{}{}", end, end.starts_with("ended") ? ", expected 0" : "", program.last_words()));
  }
  return {.output = program.output.said(), .errors = program.errors.said()};
}

}  // namespace kerf::bench
