#include "results/result_folder.h"

#include <cctype>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "http/routes.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr int max_names = 1000;
constexpr std::size_t longest_stem = 60;

/// The first of the names that is free; what a killed process left unfinished beside it goes.
/// @throws RequestError.
fs::path free_name(const Workspace& workspace, const std::string& stem, std::string_view ending) {
  for (int i = 1; i < max_names; ++i) {
    const std::string name = i == 1 ? stem : fmt::format("{}-{}", stem, i);
    if (i > 1 && workspace.regular_file(name + ".h5")) continue;  // whose own results are called so
    try {
      fs::path file = workspace.new_file(name, ending);
      require_output(file, false);
      return file;
    } catch (const RequestError& taken) {
      if (taken.status != 409) throw;
    }
  }
  throw RequestError(409,
                     fmt::format("{}{} and {} more are there; remove some of them", stem, ending, max_names));
}

}  // namespace

std::string result_stem(std::string_view name) {
  std::string_view rest = name.substr(name.rfind('/') == std::string_view::npos ? 0 : name.rfind('/') + 1);
  for (const std::string_view ending : {".h5", ".law.toml"}) {
    if (rest.ends_with(ending)) rest.remove_suffix(ending.size());
  }
  std::string stem;
  for (const char c : rest.substr(0, longest_stem)) {
    const bool is_letter_or_digit = c > 0 && std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_letter_or_digit || (!stem.empty() && (c == '_' || c == '.'))) {
      stem += c;
    } else if (!stem.empty() && stem.back() != '-') {
      stem += '-';
    }
  }
  while (!stem.empty() && std::isalnum(static_cast<unsigned char>(stem.back())) == 0) stem.pop_back();
  return stem.empty() ? "result" : stem;
}

ResultFolder::ResultFolder(const Workspace& workspace, const std::string& stem, std::string_view ending)
    : name_(free_name(workspace, stem, ending)), whole_(name_, schema::Existing::keep) {}

std::string ResultFolder::publish(Workspace& workspace, std::string_view file) {
  try {
    whole_.commit();
  } catch (const schema::NameTaken& taken) {  // by a verb, meanwhile
    name_ = taken.kept();
  }
  (void)workspace.scan();
  return workspace.id_of(name_ / file);
}

}  // namespace kerf::bench
