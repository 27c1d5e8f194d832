#include "plan/planned_file.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "files/named_file.h"
#include "laws/law_toml.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 4096;

void add_named(const fs::path& toml, std::vector<fs::path>& found);

/// Every text in a node, in the order of keys, so that it does not matter how the file is laid out.
void add_named_by(const toml::node& node, const fs::path& folder, std::vector<fs::path>& found) {
  if (const toml::table* const table = node.as_table()) {
    for (const auto& [key, each] : *table) add_named_by(each, folder, found);
  } else if (const toml::array* const list = node.as_array()) {
    for (const toml::node& each : *list) add_named_by(each, folder, found);
  } else if (const auto text = node.value_exact<std::string>()) {
    std::error_code none;
    if (text->empty() || text->size() > longest_name || text->find('\0') != std::string::npos) return;
    const fs::path file = (folder / *text).lexically_normal();
    if (!fs::is_regular_file(file, none) || std::ranges::find(found, file) != found.end()) return;
    found.push_back(file);
    if (file.extension() == ".toml") add_named(file, found);
  }
}

void add_named(const fs::path& toml, std::vector<fs::path>& found) {
  add_named_by(parse_toml(read_named_file(toml), toml.string()), toml.parent_path(), found);
}

}  // namespace

std::vector<fs::path> files_named_in(const fs::path& toml) {
  std::vector<fs::path> found;
  add_named(toml, found);
  return found;
}

PlannedFile planned_file(const SweepInput& input, const fs::path& file) {
  PlannedFile planned{.bytes = NamedFile(file).size(), .sha256 = sha256_of(file)};
  if (input.counts_with == nullptr) return planned;
  std::string all = fmt::format("kerf.files 1\n{}\n", planned.sha256);
  for (const fs::path& other : input.counts_with(file)) {
    (void)NamedFile(other);  // which says what is wrong with one that is missing
    all += sha256_of(other) + "\n";
  }
  planned.sha256 = sha256_of(std::string_view(all));
  return planned;
}

}  // namespace kerf::bench
