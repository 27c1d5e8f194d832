#include "formats/unpacked_apart.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kerf/processes/program.h>

#include "formats/mat_table.h"
#include "formats/workbook.h"
#include "formats/xls.h"

namespace kerf::bench {
namespace {

constexpr char result_mark = 'r';
constexpr char refusal_mark = 'x';
constexpr char end_of_part = '\x1E';

void write_all(const processes::Descriptor& file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file.number(), bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw std::system_error(errno, std::generic_category(), "no room for a file in memory");
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

std::string answer_of(const Unpacked& unpacked) {
  return fmt::format("{}{}{}{}{}{}", result_mark, unpacked.sheet, end_of_part,
                     fmt::join(unpacked.notes, "\n"), end_of_part, unpacked.text);
}

std::string refusal_of(std::string_view why) { return fmt::format("{}{}", refusal_mark, why); }

Unpacked unpacked_from(const std::string& answer) {
  if (answer.front() == refusal_mark) throw std::invalid_argument(answer.substr(1));
  const std::size_t first = answer.find(end_of_part);
  const std::size_t second = answer.find(end_of_part, first + 1);
  Unpacked unpacked{.sheet = answer.substr(1, first - 1), .notes = {}, .text = answer.substr(second + 1)};
  std::string_view notes = std::string_view(answer).substr(first + 1, second - first - 1);
  while (!notes.empty()) {
    const std::string_view line = notes.substr(0, notes.find('\n'));
    unpacked.notes.emplace_back(line);
    notes.remove_prefix(std::min(notes.size(), line.size() + 1));
  }
  return unpacked;
}

Unpacked unpacked_here(std::string_view bytes, const std::string& path, const std::string& sheet,
                       const UnpackedLimits& limits) {
  if (is_mat(bytes)) {
    MatTable table = mat_table(bytes, path, limits);
    return {.sheet = {}, .notes = std::move(table.notes), .text = std::move(table.text)};
  }
  Sheet found = is_xls(bytes) ? xls_sheet(bytes, sheet, limits) : Workbook(bytes, limits).sheet(sheet);
  return {.sheet = std::move(found.name), .notes = std::move(found.notes), .text = std::move(found.text)};
}

Unpacked unpacked_apart(std::string_view bytes, const std::string& sheet, const UnpackedLimits& limits) {
  const MatName named(bytes);
  const processes::Descriptor file = processes::file_in_memory();
  const processes::Descriptor told = processes::file_in_memory();
  write_all(file, bytes);
  const auto program = processes::helper_program("kerf-unpack");
  const std::array descriptors{file.number(), told.number()};
  const std::array<std::string, 4> words{limits.name, std::to_string(limits.at_most), sheet, named.name()};
  pid_t process = -1;
  if (const int error = processes::start(program, descriptors, process, words); error != 0)
    throw std::system_error(error, std::generic_category(), program.string());
  const int status = processes::wait_for(process);
  const std::string answer = processes::content_of(told);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || answer.empty())
    throw std::invalid_argument(fmt::format(
        "{}: it is damaged, or needs more memory than it may take: its reader fell over it", limits.name));
  return unpacked_from(answer);
}

}  // namespace kerf::bench
