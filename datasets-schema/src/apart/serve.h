#pragma once

#include <filesystem>

#include "apart/pieces.h"

namespace kerf::schema::apart {

/// Answers what is asked of a file, until nobody asks any more. What the file is called in a text of an
/// error, is what it is called here.
void serve(const std::filesystem::path& file, int socket, Window window);

}  // namespace kerf::schema::apart
