#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kerf::bench {

/// One file of a drawer, as study.toml has it.
struct DrawerFile {
  std::string path;              ///< below the drawer's folder
  std::string sha256;            ///< when the drawer was looked at; empty: too large to be read
  std::string found;             ///< what it holds, in words
  std::string ignored;           ///< why it takes no part; empty: it does
  std::string map;               ///< of its own, or an import file; empty: that of its layout or of the study
  std::string sheet{};           ///< of a workbook; empty: the first with numbers
  std::size_t stretch = 0;       ///< of a clock that starts anew, from 1; 0: it does not
  std::string axis{};            ///< of several, along which it is segmented and fitted; empty: not named
  std::string join{};            ///< another file with its own clock, below the drawer's folder
  std::string join_map{};        ///< its columns, or an import file
  std::string join_on{};         ///< channel of both that brings the clocks together, or "time"
  std::string join_marker{};     ///< event of both that does so instead, as parse_markers() has it
  std::string join_suggested{};  ///< by names, for a person to confirm: until then nothing is made of it
  std::string tissue;
  std::string speed;
  std::string specimen;
  std::string rig{};         ///< that it was recorded with, where there are several
  bool blank = false;        ///< the tool without a tissue
  std::string less_blank{};  ///< path of the blank to be taken off it; empty: those of its rig and speed
  std::string accepted;      ///< why it counts whatever is doubted of it; empty: a doubt leaves it out
  std::string numbers;       ///< numbers and time stamps of its name, which are no factor
};

/// A text of more is no recording of a study but a log [bytes].
inline constexpr std::uintmax_t largest_drawer_file = std::uintmax_t{512} << 20U;

/// @throws std::invalid_argument for a file beyond it.
void require_drawer_size(const std::filesystem::path& file);

/// Files of a drawer whose columns are alike.
struct StudyLayout {
  std::string files;  ///< pattern of their paths: "rig2/*.csv"; '*' stands for folders too
  std::string map;    ///< as `kerf import --map`, or an import file from the study's folder
};

/// What `kerf study run` goes by: a drawer of files, looked at and corrected by a person.
struct StudyPlan {
  static constexpr int version = 1;

  std::filesystem::path folder;  ///< the drawer; in the file relative to the study's folder
  std::string map;               ///< of text files, or an import file from the study's folder; empty: unknown
  std::vector<StudyLayout> layouts{};
  std::vector<std::string> laws;
  std::vector<std::string> law_options{};  ///< NAME=VALUE, each for the laws that have it
  bool all_cycles = false;                 ///< flagged cycles count too
  std::string blade{};  ///< law file with the shape of a blade, from the study's folder; empty: none
  std::string closing;  ///< "increasing" or "decreasing"; empty: the direction that costs more work
  std::vector<std::string> compare;  ///< what tissues and speeds are compared by: peak, work, LAW.PARAMETER
  std::string licence;               ///< of the data, a URL or a name; empty: none was given
  std::vector<std::string> people;
  bool subtracts_blanks = false;  ///< from the recordings of their rig and speed
  std::string why_blanks{};       ///< why that, or why not
  std::vector<DrawerFile> files;

  /// The map of a file: its own, else that of the first layout that it fits, else the study's.
  [[nodiscard]] const std::string& map_of(const DrawerFile& file) const;
  /// The entry of a file; one with its path alone if there is none.
  [[nodiscard]] DrawerFile file_called(const std::string& path) const;
  /// Every map that is named, in the order of the file; some more than once.
  [[nodiscard]] std::vector<std::string> named_maps() const;
};

/// What an import refuses, with the keys of study.toml in place of options: join_on for --join-on.
[[nodiscard]] std::string in_words_of_study(std::string message);

/// Laws to begin with: the usual ones but those of which a fit takes one more arm while held-out data pay for
/// it, ten times as long as all others together; study.toml may name them.
[[nodiscard]] std::vector<std::string> laws_to_begin_with();

/// As TOML with comments that say how to correct it.
[[nodiscard]] std::string study_text(const StudyPlan& study);

/// @throws std::invalid_argument with file and line for what is no study: another version, an unknown key or
///         law, a path that leaves the drawer.
[[nodiscard]] StudyPlan read_study(const std::filesystem::path& file);

/// Names of the files that take part, in their order, empty for those that do not: the stem, with a number
/// where two have the same.
[[nodiscard]] std::vector<std::string> recording_names(const StudyPlan& study);

}  // namespace kerf::bench
