#include <stdexcept>
#include <string>

#include "formats/file_text.h"
#include "fuzz/scratch_folder.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// What an import makes text of, by its content: gzip, UTF-16, workbooks, MAT-files. The bytes are the file.
void fuzz_formats(Bytes bytes) {
  static const ScratchFolder folder;
  constexpr std::size_t most = std::size_t{1} << 20U;
  const auto file = folder.write("fuzz.bin", text_of(bytes));
  std::string text;
  (void)is_taken<std::invalid_argument>([&] {
    const bench::FileText read(file, {.max_bytes = most});
    text = read.text();
    promise(read.bytes() == text_of(bytes), "the file is hashed as it is");
  });
  constexpr std::size_t most_of_numbers = 32;  // a number takes as long as a double does, at most
  promise(text.size() <= most_of_numbers * most, "no more is unpacked than is allowed");
}

const Registered registered("formats", fuzz_formats);

}  // namespace
}  // namespace kerf::fuzz
