#include "export_law.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "c/c_source.h"
#include "files/named_file.h"
#include "files/whole_file.h"
#include "own_code/compiler.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

/// "liver_2" for "Liver 2.law.toml".
std::string identifier_of(const std::filesystem::path& law) {
  std::string stem = law.filename().string();
  stem = stem.substr(0, stem.find('.'));
  std::string name;
  for (const char c : stem) {
    const auto letter = static_cast<unsigned char>(c);
    name += std::isalnum(letter) != 0 && letter < 128 ? static_cast<char>(std::tolower(letter)) : '_';
  }
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0 || name.front() == '_')
    name = "law_" + name;
  return name.substr(0, 60);
}

}  // namespace

std::span<const Host> hosts() {
  static const std::vector<Host> all{plain_c_host(), fmu_host(),  octave_host(), python_host(),
                                     chai3d_host(),  sofa_host(), unity_host()};
  return all;
}

const Host& host_named(std::string_view name) {
  const auto found = std::ranges::find(hosts(), name, &Host::name);
  if (found != hosts().end()) return *found;
  std::string known;
  for (const Host& host : hosts()) known += (known.empty() ? "" : ", ") + std::string(host.name);
  throw std::invalid_argument(fmt::format("there is no host '{}'; the hosts are {}", name, known));
}

ExportedLaw read_for(const Host& host, const std::filesystem::path& law, const std::string& name) {
  ExportedLaw exported{.name = name.empty() ? identifier_of(law) : name, .file = read_law_file(law)};
  require_name(exported.name, "an export");
  exported.text = read_named_file(law);
  exported.sha256 = sha256_of(std::string_view(exported.text));
  exported.file.name = law.string();
  if (host.takes_c) {
    try {
      exported.plain_c = c_source(exported);
    } catch (const std::invalid_argument& why) {
      throw std::invalid_argument(
          fmt::format("{}: {}; libkerf carries every law (docs/library.md), and --as unity calls it",
                      law.string(), why.what()));
    }
  }
  return exported;
}

std::vector<std::string> write_for(const Host& host, const ExportedLaw& law,
                                   const std::filesystem::path& folder) {
  std::vector<std::string> names;
  const std::vector<HostFile> files = [&] {
    try {
      return host.files(law);
    } catch (const std::invalid_argument& why) {
      throw std::invalid_argument(fmt::format("{}: {}", law.file.name, why.what()));
    }
  }();
  for (const HostFile& file : files) {
    const std::filesystem::path path = folder / file.name;
    std::filesystem::create_directories(path.parent_path());
    write_whole_file(path, file.content);
    names.push_back(file.name);
  }
  return names;
}

}  // namespace kerf::bench
