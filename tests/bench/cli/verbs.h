#pragma once

#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "support/program.h"

namespace kerf::test {

/// A verb as `kerf --help` lists it.
struct VerbOfGroup {
  std::string group;
  std::string name;
};

inline std::vector<VerbOfGroup> verbs_in_help() {
  std::istringstream lines(run_kerf({"--help"}).output);
  std::vector<VerbOfGroup> verbs;
  std::string group;
  std::smatch found;
  for (std::string line; std::getline(lines, line);) {
    if (!std::regex_match(line, found, std::regex("([a-z]*) +([a-z]+) +[A-Z].*"))) continue;
    if (found[1].length() > 0) group = found[1];
    verbs.push_back({.group = group, .name = found[2]});
  }
  return verbs;
}

/// The words of every verb, those of `kerf session` included, which its help lists under "Subcommands:".
inline std::vector<std::vector<std::string>> all_verbs() {
  std::vector<std::vector<std::string>> all;
  for (const VerbOfGroup& verb : verbs_in_help()) {
    all.push_back({verb.name});
    const std::string help = run_kerf({verb.name, "--help"}).output;
    const auto begin = help.find("Subcommands:\n");
    if (begin == std::string::npos) continue;
    all.pop_back();
    std::istringstream lines(help.substr(begin));
    std::smatch found;
    for (std::string line; std::getline(lines, line) && !line.empty();) {
      if (std::regex_match(line, found, std::regex("  ([a-z]+) +.*"))) all.push_back({verb.name, found[1]});
    }
  }
  return all;
}

}  // namespace kerf::test
