#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "subject/subject.h"

namespace kerf::bench {

/// Text in lines of at most so many characters, broken at blanks; its own line breaks stay. Control
/// characters, which could do things to a terminal, are left out.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t columns);

/// What stands on a terminal.
struct SubjectScreen {
  std::vector<std::string> body;
  std::vector<std::string> foot;  ///< always to be seen: what the keys do, and a notice
  std::shared_ptr<const SubjectTexts> texts = english_texts();
};

/// In lines no wider than so many characters.
[[nodiscard]] SubjectScreen screen_of(const SubjectView& view, const std::string& keys,
                                      const std::string& hint, std::size_t columns);

/// The lines of one page of it, where it has more lines than the terminal, and of how many pages it is.
struct SubjectScreenPage {
  std::vector<std::string> lines;
  std::size_t pages = 1;
};
[[nodiscard]] SubjectScreenPage page_of(const SubjectScreen& screen, std::size_t page, std::size_t rows);

/// What there is to say of a view after another, in plain lines: all of it on a new screen, otherwise what
/// has changed.
[[nodiscard]] std::vector<std::string> said_of(const SubjectView& before, const SubjectView& now);

}  // namespace kerf::bench
