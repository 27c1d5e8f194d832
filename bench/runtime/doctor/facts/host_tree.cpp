#include "doctor/facts/host_tree.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace kerf::bench::doctor {

namespace fs = std::filesystem;

fs::path HostTree::file(std::string_view path) const {
  while (path.starts_with('/')) path.remove_prefix(1);
  return root_ / path;
}

std::optional<std::string> HostTree::text(std::string_view path) const {
  // Files of the kernel tell no size, and are asked for thousands of times: no stream is put around them.
  const int descriptor = open(file(path).c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return std::nullopt;
  std::string content;
  std::array<char, 4096> part{};
  ssize_t count = 0;
  while ((count = read(descriptor, part.data(), part.size())) > 0) {
    content.append(part.data(), static_cast<std::size_t>(count));
  }
  close(descriptor);
  if (count < 0) return std::nullopt;
  content.erase(content.find_last_not_of(" \t\n") + 1);
  return content;
}

std::optional<std::int64_t> HostTree::number(std::string_view path) const {
  const auto content = text(path);
  if (!content) return std::nullopt;
  const auto words = words_of(*content);
  return words.empty() ? std::nullopt : number_of(words.front());
}

std::vector<std::string> HostTree::names(std::string_view folder) const {
  std::vector<std::string> found;
  std::error_code error;
  for (fs::directory_iterator at(file(folder), error), end; !error && at != end; at.increment(error)) {
    found.push_back(at->path().filename().string());
  }
  std::ranges::sort(found);
  return found;
}

std::optional<std::string> HostTree::resolved(std::string_view path) const {
  std::error_code error;
  const fs::path target = fs::canonical(file(path), error);
  if (error) return std::nullopt;
  const fs::path root = fs::canonical(root_, error);
  if (error) return std::nullopt;
  return "/" + target.lexically_relative(root).string();
}

bool HostTree::has(std::string_view path) const {
  std::error_code error;
  return fs::exists(file(path), error);
}

std::optional<bool> runs(const HostTree& tree, std::string_view program) {
  bool any = false;
  for (const std::string& name : tree.names("/proc")) {
    if (!number_of(name)) continue;
    any = true;
    if (tree.text("/proc/" + name + "/comm") == program) return true;
  }
  return any ? std::optional(false) : std::nullopt;
}

bool is_in_list(std::string_view list, int number) {
  while (!list.empty()) {
    const std::string_view part = list.substr(0, list.find(','));
    list.remove_prefix(std::min(part.size() + 1, list.size()));
    const auto dash = part.find('-');
    const auto first = number_of(part.substr(0, dash));
    const auto last = dash == std::string_view::npos ? first : number_of(part.substr(dash + 1));
    if (first && last && number >= *first && number <= *last) return true;
  }
  return false;
}

std::string processors_but(const HostTree& tree, int processor) {
  constexpr int most = 4096;
  const std::string online = tree.text("/sys/devices/system/cpu/online").value_or("");
  std::string list;
  for (int first = 0; first < most; ++first) {
    const auto counts = [&](int cpu) { return cpu != processor && is_in_list(online, cpu); };
    if (!counts(first)) continue;
    int last = first;
    while (counts(last + 1)) ++last;
    if (!list.empty()) list += ',';
    list += std::to_string(first);
    if (last > first) list += '-' + std::to_string(last);
    first = last;
  }
  return list.empty() ? "0" : list;
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    lines.push_back(line);
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return lines;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view blanks = " \t\n";
  for (auto begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const auto end = std::min(line.find_first_of(blanks, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(blanks, end);
  }
  return words;
}

std::optional<std::int64_t> number_of(std::string_view word) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return number;
}

}  // namespace kerf::bench::doctor
