#include "laws/plugin_mention.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include <kerf/drivers/toml_text.h>
#include <kerf/models/foreign.h>

namespace kerf::bench {
namespace {

std::mutex noting;
std::vector<std::string> notes;

std::string in_short(std::string_view sha256) { return std::string(sha256.substr(0, 12)); }

}  // namespace

void note_of_plugin(std::string note) {
  const std::lock_guard lock(noting);
  if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
}

std::string plugin_text(const models::Law& law) {
  const models::ForeignLaw* const foreign = models::foreign_law(law.model());
  if (foreign == nullptr) return "";
  return fmt::format("\n[plugin]\nname = {}\nsha256 = \"{}\"\n", drivers::toml_text(foreign->plugin().name),
                     foreign->plugin().sha256);
}

std::string plugin_in_words(const models::Law& law) {
  const models::ForeignLaw* const foreign = models::foreign_law(law.model());
  if (foreign == nullptr) return "";
  return fmt::format("the plug-in {}, SHA-256 {}", foreign->plugin().name, foreign->plugin().sha256);
}

void require_plugin(const Place& place, const toml::table& root, std::string_view model,
                    const PluginTerms& terms) {
  if (root.get("plugin") == nullptr) return;
  const toml::table& table = place.table(root, "plugin");
  place.allow_only(table, {"name", "sha256"}, "[plugin]");
  const std::string name = place.text(table, "name", "");
  const std::string sha256 = place.text(table, "sha256", "");
  const models::ForeignLaw* const foreign = models::foreign_law(model);
  if (foreign == nullptr) {
    place.refuse(table, "law '{}' is of the plug-in {} (SHA-256 {}...), {}{}", model, name, in_short(sha256),
                 terms.advice, name);
  }
  if (foreign->plugin().sha256 == sha256) return;
  if (!terms.of_any_content) {
    place.refuse(
        table,
        "law '{}' is of the plug-in {} of SHA-256 {}..., and {} is of {}...: load the one that it was "
        "made with, or fit the law anew",
        model, name, in_short(sha256), foreign->plugin().path, in_short(foreign->plugin().sha256));
  }
  note_of_plugin(fmt::format(
      "{}: made with the plug-in {} of SHA-256 {}..., and {} is of {}...: its forces may be others",
      place.file(), name, in_short(sha256), foreign->plugin().path, in_short(foreign->plugin().sha256)));
}

std::vector<std::string> take_plugin_notes() {
  const std::lock_guard lock(noting);
  return std::exchange(notes, {});
}

}  // namespace kerf::bench
