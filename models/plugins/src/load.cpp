#include "kerf/plugins/load.h"

#include <stdexcept>

#include <dlfcn.h>

#include "crash.h"

namespace kerf::plugins {

Plugin load(const std::filesystem::path& file, const std::string& sha256) {
  const std::string name = file.string();
  const Trial trial = try_law(file);
  void* const library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::invalid_argument(name + ": " + dlerror());
  const auto describe = reinterpret_cast<const kerf_law_v1* (*)()>(dlsym(library, "kerf_law"));
  const kerf_law_v1* const law = describe == nullptr ? nullptr : describe();
  if (law == nullptr) throw std::invalid_argument(name + ": it has changed while it was loaded");
  try {
    const models::ForeignLaw& registered =
        models::register_law(*law, {.path = name, .name = file.filename().string(), .sha256 = sha256});
    blame_crashes();
    return {.law = &registered, .trial = trial};
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(name + ": " + error.what());
  }
}

}  // namespace kerf::plugins
