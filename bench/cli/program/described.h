#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace kerf::bench {

/// An option, or a value without a name, as --help tells of it.
struct DescribedOption {
  std::vector<std::string> names;    ///< -o, --output; of a value without a name that alone: RECORDING
  std::string value;                 ///< as --help prints it: "TEXT:{contact,all}=contact"; empty for a flag
  std::string description;           ///< a line
  std::vector<std::string> choices;  ///< the words that it takes, if only some
  bool takes_value = false;          ///< false: a flag
  bool takes_text = false;           ///< and not a number
  bool repeated = false;             ///< takes any number of values
  bool required = false;
};

/// A verb as --help tells of it.
struct DescribedVerb {
  std::vector<std::string> words;  ///< {"session", "new"}; none: the program itself
  std::string group;               ///< by what one wants to do; that of a verb's verbs is empty
  std::string description;         ///< a line
  std::string footer;              ///< what stands below the options: an example and what else is to be said
  std::vector<DescribedOption> values;
  std::vector<DescribedOption> options;
  std::vector<std::string> verbs;  ///< its own; then it has no values
};

/// The program, and every verb that --help lists, each before its own verbs: for whoever puts them in another
/// form.
[[nodiscard]] std::vector<DescribedVerb> describe(const CLI::App& program);

}  // namespace kerf::bench
