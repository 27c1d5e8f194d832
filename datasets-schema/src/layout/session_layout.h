#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "validate/tree_check.h"

/// The layout of `kerf.session`, once: the reader, the validator and the document go by it.
namespace kerf::schema::session_layout {

struct SessionAttribute {
  std::string_view object;  ///< "/laws/NNNNNN": of each law
  AttributeRule rule;
  std::string_view description;
};
[[nodiscard]] std::span<const SessionAttribute> session_attributes();

inline constexpr std::size_t salt_bytes = 16;
inline constexpr std::string_view any_law = "/laws/NNNNNN";
inline constexpr std::string_view type_of_entries = "{kind text, time text, text text}";
inline const std::string protocol = "/protocol";
inline const std::string laws = "/laws";
inline const std::string key = "/key";
inline const std::string entries = "/entries";
inline const std::string sealed = "/sealed";

/// "/sealed/000007"
[[nodiscard]] std::string numbered(const std::string& group, std::size_t number);

/// Compares the tree of a session with the layout.
void check(TreeCheck& tree);

}  // namespace kerf::schema::session_layout
