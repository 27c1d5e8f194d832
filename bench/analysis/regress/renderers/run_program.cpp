#include "regress/renderers/run_program.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>

#include "regress/renderers/child_program.h"

namespace kerf::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds look_every{10};  ///< at the size of what it writes

bool too_large(const ProgramRun& run) {
  std::error_code none;
  const std::uintmax_t size = std::filesystem::file_size(run.output, none);
  return !none && size > run.output_at_most;
}

/// Why it has to be killed; empty: it ended.
std::string watch(const ProgramRun& run, ChildProgram& program) {
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(run.timeout);
  for (;;) {
    const bool has_ended = program.wait({}, std::min(deadline, Clock::now() + look_every));
    if (too_large(run)) {
      return fmt::format(
          "the renderer wrote more than {} bytes of forces, more than its rows can take, and was killed",
          run.output_at_most);
    }
    if (has_ended) return {};
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
  const auto fail = [&](const std::string& what) {
    throw RendererError(what + program.last_words(), last_lines(program.errors.said()));
  };
  if (!why.empty()) fail(why);
  if (status != 0) {
    const std::string end = end_in_words(status);
    fail(fmt::format("the renderer {}{}", end, end.starts_with("ended") ? ", expected 0" : ""));
  }
  return {.output = program.output.said(), .errors = program.errors.said()};
}

}  // namespace kerf::bench
