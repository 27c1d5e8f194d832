#pragma once

#include <span>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

namespace kerf::bench {

struct Context;

/// Imports the texts among the files that a verb reads as recordings, by the maps of --map (Context::maps),
/// as `kerf import` does, warnings included. Until the program ends what was imported stands in for each, in
/// a file without a name (schema::let_stand_in()): nothing is left of it, whatever ends the program. Files
/// that are HDF5 stay as they are. "-" becomes /dev/stdin, and pipes are kept to be read again (keep_pipe()).
/// Does nothing without a map.
/// @throws std::invalid_argument where none of them is a text, and as import_text() and keep_pipe() do;
///         std::system_error.
void import_on_the_way(std::span<std::string> files, Context& context);

/// Puts what was imported into the verb's JSON, as `imported_on_the_way`: of each text its name, its SHA-256
/// and what `kerf import --json` says of it but for its duration.
void tell_imported_on_the_way(Context& context);

/// What is to be known of a recording that has just been imported (first_look()), by what is felt of its
/// force.
[[nodiscard]] std::vector<std::string> first_look_of(const schema::Recording& recording);

/// Of a verb that changes the recording it is given. @throws std::invalid_argument if there is a map.
void refuse_import_on_the_way(const std::string& verb, const std::string& file, const Context& context);

}  // namespace kerf::bench
