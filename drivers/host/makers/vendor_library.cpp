#include "makers/vendor_library.h"

#include <stdexcept>

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

namespace kerf::host {

VendorLibrary::VendorLibrary(const Wanted& wanted) : what_(wanted.what) {
  std::string unusable;
  for (const std::string& file : wanted.files) {
    library_ = dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library_ != nullptr) break;
    const std::string why = dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread, by glibc
    // One that is there and misses another library, or is for another processor, is what has to be told.
    if (!why.starts_with(file + ": cannot open shared object file: No such file") && unusable.empty())
      unusable = fmt::format("{} is there and cannot be loaded: {}", file, why);
  }
  if (library_ == nullptr) {
    throw std::runtime_error(!unusable.empty() ? unusable
                                               : fmt::format("{} is not installed (there is no {}): {}",
                                                             what_, wanted.files.front(), wanted.mend));
  }
  const link_map* map = nullptr;
  if (dlinfo(library_, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr) file_ = map->l_name;
}

void* VendorLibrary::symbol(const char* name) const noexcept { return dlsym(library_, name); }

void VendorLibrary::require() const {
  if (missing_.empty()) return;
  throw std::runtime_error(fmt::format("{} lacks {}: it is no {}, or of a version that is not known here",
                                       file_, missing_, what_));
}

}  // namespace kerf::host
