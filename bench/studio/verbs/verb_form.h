#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace kerf::bench {

/// What a form asks for where a verb takes a value.
enum class ValueKind : std::uint8_t {
  flag,
  number,
  choice,  ///< one of `words`
  text,    ///< of one's own, no file
  laws,    ///< names of laws, several with commas between
  device,  ///< the URI of a simulated one
  file,    ///< of the workspace, whose name ends with one of `words`
  folder,  ///< of the workspace
  output   ///< a new name in the workspace, which gets the first of `words` as its ending; "": a folder
};

/// An option of a verb, or a value without a name, as a form asks for it.
struct VerbValue {
  std::string name;   ///< as it is typed: "--filter", "RECORDING"
  std::string label;  ///< what it is, in a line
  ValueKind kind = ValueKind::text;
  std::vector<std::string> words = {};
  std::string standard = {};  ///< what it is where nothing is given
  bool positional = false;    ///< its name is not typed
  bool required = false;
  bool repeated = false;  ///< takes several
};

/// A verb of the program as a form.
struct VerbForm {
  std::string verb;   ///< as it is typed: "session simulate"
  std::string title;  ///< in the words of who looks for it
  std::string group;
  std::string description;  ///< its line of `kerf --help`
  std::string more;         ///< the rest of its --help
  std::vector<VerbValue> values;
  std::vector<std::string> fixed = {};  ///< words that are always typed, such as "--virtual"
  bool needs_key = false;               ///< the key file of the studio is given to it
};

[[nodiscard]] nlohmann::ordered_json to_json(const VerbForm& form);

}  // namespace kerf::bench
