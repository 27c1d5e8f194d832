#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/schema/sweep_tables_file.h>

#include "validate/tree_check.h"

namespace kerf::schema::sweep_layout {

inline const std::string values = "/values";
inline constexpr std::string_view column_of_cells = "cell";
/// Of a column of codes: the texts that they are places in.
[[nodiscard]] std::string texts_of(const std::string& input);

/// Texts of the root, besides its schema.
struct RootText {
  const char* name;
  std::string SweepTablesFacts::*text;
};
inline constexpr RootText root_texts[] = {{"plan_sha256", &SweepTablesFacts::plan_sha256},
                                          {"plan", &SweepTablesFacts::plan},
                                          {"software", &SweepTablesFacts::software},
                                          {"cells", &SweepTablesFacts::cells}};

/// By its type in the file.
[[nodiscard]] std::optional<SweepColumn::Type> column_type(std::string_view type);

/// Groups of the root that are tables.
[[nodiscard]] std::vector<std::string> tables_of(hid_t file);

/// Keeps what of the tree departs from what it has to be.
void check(TreeCheck& tree);

}  // namespace kerf::schema::sweep_layout
