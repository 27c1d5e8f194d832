#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kerf::bench::doctor {

/// What the system tells of itself in /proc, /sys, /dev, /run and /boot, read below a root folder: "/", or a
/// copy of another machine's. Whatever is missing or may not be read is nothing, never a guess. Paths are
/// those of the system, "/proc/cmdline".
class HostTree {
 public:
  explicit HostTree(std::filesystem::path root = "/") : root_(std::move(root)) {}

  /// The text of a file without white space at its end; nothing if it cannot be read.
  [[nodiscard]] std::optional<std::string> text(std::string_view path) const;
  /// The number that a file begins with; nothing if it does not begin with one.
  [[nodiscard]] std::optional<std::int64_t> number(std::string_view path) const;
  /// What is in a folder, by name; empty if it cannot be read.
  [[nodiscard]] std::vector<std::string> names(std::string_view folder) const;
  /// Where links lead in the end, as a path of the system; nothing if there is nothing.
  [[nodiscard]] std::optional<std::string> resolved(std::string_view path) const;
  [[nodiscard]] bool has(std::string_view path) const;
  /// The same file as this process may open it.
  [[nodiscard]] std::filesystem::path file(std::string_view path) const;

 private:
  std::filesystem::path root_;
};

/// Whether a program of that name runs, by /proc; nothing if no process is shown there.
[[nodiscard]] std::optional<bool> runs(const HostTree& tree, std::string_view program);

/// Whether a list of the kernel's, "0-2,5", holds a number. What is no list holds none.
[[nodiscard]] bool is_in_list(std::string_view list, int number);

/// The processors that are at work but one, as such a list: "0-2"; "0" where that is not told.
[[nodiscard]] std::string processors_but(const HostTree& tree, int processor);

/// A text in its lines, without the last line's end.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);
/// A line in its words, apart by blanks and tabulators.
[[nodiscard]] std::vector<std::string_view> words_of(std::string_view line);
/// The whole number that a word is; nothing if it is none.
[[nodiscard]] std::optional<std::int64_t> number_of(std::string_view word);

}  // namespace kerf::bench::doctor
