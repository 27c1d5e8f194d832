#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <kerf/models/law.h>

namespace kerf::bench {

/// A law whose equation is in metres says nothing of an angle.
[[nodiscard]] bool units_fit(const models::LawInfo& law, std::string_view position_unit,
                             std::string_view force_unit);

/// Of options written as NAME=VALUE those that a law has, each of the type it has there. The last of a name
/// counts.
/// @throws std::invalid_argument for a text that is not NAME=VALUE, or a value of another type.
[[nodiscard]] models::Options options_of_law(std::string_view model, const std::vector<std::string>& given);

/// @throws std::invalid_argument if none of the laws has one of the options, or as options_of_law() does.
void check_law_options(const std::vector<std::string>& models, const std::vector<std::string>& given);

}  // namespace kerf::bench
