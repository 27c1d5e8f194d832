#include "kerf/plugins/open.h"

#include <stdexcept>

#include <dlfcn.h>

namespace kerf::plugins {

Describe describing_function(const std::filesystem::path& file) {
  const std::string path = std::filesystem::absolute(file).string();
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const std::string why = dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread, by glibc
    throw std::invalid_argument("it is no shared object that can be opened: " +
                                (why.starts_with(path + ": ") ? why.substr(path.size() + 2) : why));
  }
  const auto describe = reinterpret_cast<Describe>(dlsym(library, "kerf_plugin_law"));
  if (describe == nullptr)
    throw std::invalid_argument("it exports no kerf_plugin_law(): it is no law, or hides it");
  return describe;
}

const models::ForeignLaw& open(const std::filesystem::path& file, const std::string& sha256) {
  try {
    const kerf_law_v1* const law = describing_function(file)();
    if (law == nullptr) throw std::invalid_argument("its kerf_plugin_law() returns nothing");
    return models::register_law(*law,
                                {.path = file.string(), .name = file.filename().string(), .sha256 = sha256});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(file.string() + ": " + error.what());
  }
}

}  // namespace kerf::plugins
