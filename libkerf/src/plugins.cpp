#include "plugins.h"

#include <vector>

#include <kerf/models/foreign.h>
#include <kerf/plugins/open.h>

namespace kerf {
namespace {

/// None where there is no memory for the list.
std::vector<const models::ForeignLaw*> all() noexcept {
  try {
    return models::foreign_laws();
  } catch (...) {
    return {};
  }
}

/// That of a whole text, and so it ends in a zero.
const char* name_of(const models::ForeignLaw& law) noexcept { return law.info().name.data(); }

}  // namespace

const char* loaded_plugin(const std::string& path, const std::string& sha256) {
  for (const models::ForeignLaw* const law : all()) {
    if (law->plugin().sha256 == sha256) return name_of(*law);
  }
  return name_of(plugins::open(path, sha256));
}

const char* plugin_model(std::size_t place) noexcept {
  const auto laws = all();
  return place < laws.size() ? name_of(*laws[place]) : nullptr;
}
std::size_t plugin_count() noexcept { return all().size(); }

}  // namespace kerf
