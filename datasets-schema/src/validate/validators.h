#pragma once

#include <filesystem>
#include <vector>

#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/sweep_tables.h>
#include <kerf/schema/validate.h>

#include "validate/tree_check.h"

namespace kerf::schema {

/// The schemas beside that of recordings. Each adds what departs from its own.
/// @throws h5::Error (damage), as validate() otherwise.
void validate_session(const std::filesystem::path& file, std::vector<Violation>& violations);
void validate_regression(const std::filesystem::path& file, std::vector<Violation>& violations);
void validate_sweep_tables(const std::filesystem::path& file, std::vector<Violation>& violations);

}  // namespace kerf::schema
