#pragma once

#include <string>

namespace kerf::bench {

/// What the import says, for whoever has a page and not the program's options: where it names an option of
/// `kerf import`, the field of the page that is the same, by its label.
[[nodiscard]] std::string in_page_words(std::string message);

}  // namespace kerf::bench
