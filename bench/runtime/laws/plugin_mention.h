#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>

#include "laws/law_toml.h"

// What law files say of plug-ins, without loading any (plugin_laws.h does).

namespace kerf::bench {

/// What a law file says of the plug-in that its law is of: "[plugin]" with its name and SHA-256. Empty for a
/// law of the house.
[[nodiscard]] std::string plugin_text(const models::Law& law);
/// "the plug-in mylaw.so, SHA-256 ..."; empty likewise.
[[nodiscard]] std::string plugin_in_words(const models::Law& law);

/// Holds what a law file says of its plug-in against what is loaded.
/// @throws std::invalid_argument where the law needs a plug-in that is not given, or one of another content.
void require_plugin(const Place& place, const toml::table& root, std::string_view model,
                    const PluginTerms& terms);

/// Keeps a line that is to be told of plug-ins, once.
void note_of_plugin(std::string note);

/// What is to be told of plug-ins since the last call, a line each: a step that allocates or is slow, a law
/// file of another content.
[[nodiscard]] std::vector<std::string> take_plugin_notes();

}  // namespace kerf::bench
