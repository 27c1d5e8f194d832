#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "verbs/verb_form.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// A command line of the program that a page has asked for, in the workspace's folder.
struct VerbOrder {
  std::vector<std::string> words;
  std::vector<std::string> outputs;  ///< files and folders that it makes, by their names in the workspace
};

/// What a page has filled in, {"RECORDING": "cut.h5", "--bias": true, "--through": ["a.law.toml"]}, as a
/// command line. A file is a regular one of the workspace, an output a name that is free, a device a
/// simulated one; what the form does not have is refused.
/// @throws RequestError 400 or 409 that begins with the value's name.
[[nodiscard]] VerbOrder verb_order(const VerbForm& form, const nlohmann::json& given,
                                   const Workspace& workspace);

/// A command line as a person would type it.
[[nodiscard]] std::string as_typed(const std::vector<std::string>& words);

}  // namespace kerf::bench
