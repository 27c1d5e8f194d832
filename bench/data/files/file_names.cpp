#include "files/file_names.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <system_error>

#include <fmt/core.h>

#include "files/named_file.h"

namespace kerf::bench {

std::string as_file_name(const std::string& text) {
  constexpr std::size_t longest = 100;
  std::size_t size = std::min(text.size(), longest);
  const auto continues = [&](std::size_t i) {
    return (static_cast<unsigned char>(text[i]) & 0xC0U) == 0x80U;
  };
  while (size > 0 && size < text.size() && continues(size)) --size;  // not within a character of UTF-8
  std::string name = text.substr(0, size);
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && std::isalnum(byte) == 0 && c != '-' && c != '.') c = '_';
  }
  if (name.starts_with('.')) name.front() = '_';
  return name;
}

std::vector<std::filesystem::path> files_within(
    const std::filesystem::path& folder, const std::function<bool(const std::filesystem::path&)>& enters) {
  require_named_folder(folder);
  std::vector<std::filesystem::path> files;
  for (auto entry = std::filesystem::recursive_directory_iterator(folder);
       entry != std::filesystem::recursive_directory_iterator(); ++entry) {
    const std::filesystem::path& path = entry->path();
    const bool is_folder = !entry->is_symlink() && entry->is_directory();
    const bool is_entered = is_folder && enters(path);
    std::error_code locked;
    if (is_entered) (void)std::filesystem::directory_iterator(path, locked);
    if (!is_entered || locked) entry.disable_recursion_pending();
    if (!is_folder || locked) files.push_back(path);
  }
  std::ranges::sort(files);
  return files;
}

std::filesystem::path NewNames::take(const std::filesystem::path& wanted) {
  std::filesystem::path name = wanted;
  for (int i = 2; !taken_.insert(name).second; ++i) name = fmt::format("{}-{}", wanted.string(), i);
  return name;
}

}  // namespace kerf::bench
