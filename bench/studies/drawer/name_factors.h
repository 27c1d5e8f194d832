#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kerf::bench {

/// What the name of a file and of its folders suggest of a recording.
struct NameFactors {
  std::string tissue;    ///< the words that are nothing else, with blanks between
  std::string speed;     ///< slow, fast and the like, or a number with a unit of speed: "5mms"
  std::string specimen;  ///< "s3", "specimen2", "donor4": such a word and a number in one
  std::string rig;       ///< "rig2", "tool1": such a word and a number in one
  bool blank = false;    ///< blank, empty, air, idle, unloaded
  std::string numbers;   ///< numbers, time stamps and repetitions: "14 1853"
};

/// The words of a name without its extension, in lower case.
[[nodiscard]] std::vector<std::string> words_of_name(const std::filesystem::path& path);

/// Words end at '_', '-', '.', blanks, brackets and folders; case does not count. The path is below the
/// drawer.
[[nodiscard]] NameFactors name_factors(const std::filesystem::path& path);

}  // namespace kerf::bench
