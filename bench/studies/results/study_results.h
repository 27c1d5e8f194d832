#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/population/compare.h>
#include <kerf/population/group.h>

#include "drawer/study_file.h"
#include "run/doubts.h"
#include "run/held_out.h"

namespace kerf::bench {

/// A blank that was taken off recordings, whose error they share.
struct SharedBlank {
  std::string name;
  population::Shared values;  ///< of all recordings, those less other blanks as they are
};

/// A quantity of the recordings of a group, over its specimens.
struct StudiedQuantity {
  std::string name;  ///< "peak", "work", "kelvin.series_stiffness"
  std::string unit;
  bool is_logarithm = false;            ///< the estimate is of natural logarithms, and differences are ratios
  std::vector<std::string> recordings;  ///< of the values
  std::vector<population::Estimate> values;  ///< one a recording, of logarithms as they are
  std::vector<SharedBlank> blanks{};         ///< that were taken off any of these recordings
  population::GroupEstimate estimate;
};

/// How a law does in a group.
struct LawInGroup {
  std::string model;
  std::size_t free_parameters = 0;
  std::size_t serves = 0;               ///< recordings on whose held-out cycles it is within the JND
  population::GroupEstimate held_out;   ///< errors on a recording's own cycles, in JNDs
  population::GroupEstimate on_others;  ///< errors on recordings that it was not fitted to, in JNDs
};

/// The recordings of one tissue at one speed.
struct StudiedGroup {
  std::string tissue;
  std::string speed;
  std::vector<std::size_t> counted{};  ///< places of the recordings that count
  std::size_t left_out = 0;            ///< that do not: blanks are in no group
  std::vector<ErrorOnOthers> on_others{};
  std::vector<LawInGroup> laws{};  ///< in the order of the study's
  std::vector<StudiedQuantity> quantities{};
  std::string serving{};  ///< the simplest law that serves in every recording that counts; empty: none does

  [[nodiscard]] std::string name() const;
};

/// Two groups held against each other by one quantity.
struct StudiedComparison {
  std::string quantity;
  std::string unit;
  bool is_logarithm = false;
  std::string by;  ///< "tissue" or "speed"
  std::string first;
  std::string second;
  population::Comparison found;
};

/// What a study says, with how many recordings and specimens it stands on.
struct Conclusion {
  enum class Says : std::uint8_t { yes, partly, no, unknown };
  Says says = Says::unknown;
  std::string sentence;
};

/// Everything that a study has found.
struct StudyResults {
  std::string name;
  StudyPlan plan;
  std::vector<DrawerRecording> recordings{};  ///< those that take part, blanks too
  std::vector<StudiedGroup> groups{};         ///< by tissue, then speed
  std::string law{};  ///< that serves most recordings, the simplest of those; empty: nothing was fitted
  std::vector<StudiedComparison> comparisons{};
  std::vector<Conclusion> conclusions{};
};

/// Why the parameters of a law are not of one quantity in all recordings, and how they become so; empty where
/// they are. Such parameters are neither pooled nor compared.
[[nodiscard]] std::string why_not_of_one_quantity(const StudyResults& results, const std::string& model);

/// Sorts the recordings into groups.
void form_groups(StudyResults& results);
/// Fills in all that follows from the recordings and the errors on others of each group.
void conclude(StudyResults& results);

[[nodiscard]] nlohmann::ordered_json study_as_json(const StudyResults& results);

/// "0.43 (0.31 to 0.6; 5 specimens)", of logarithms as they were before; "unknown" without a value.
[[nodiscard]] std::string in_words(const population::GroupEstimate& estimate, bool is_logarithm);

}  // namespace kerf::bench
