#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace kerf::test {

/// What of a modelDescription.xml is not as FMI 3.0 has it for Co-Simulation with scalars of Float64: its
/// schema's elements in their order and their attributes, and what importers ask for beyond the schema.
[[nodiscard]] std::vector<std::string> broken_rules(const pugi::xml_document& description);

/// What of a zip archive an importer of FMI need not read.
[[nodiscard]] std::vector<std::string> broken_zip_rules(std::string_view archive);

}  // namespace kerf::test
