#include <stdexcept>
#include <string>

#include "formats/tdms/tdms.h"
#include "formats/tdms/tdms_segments.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// A TDMS file's segments, and the text that is made of them.
void fuzz_tdms(Bytes bytes) {
  const std::string_view file = text_of(bytes);
  std::size_t values = 0;
  (void)is_taken<std::invalid_argument>([&] {
    for (const bench::TdmsChannel& channel : bench::tdms_segments(file, "fuzz.tdms").channels)
      values += channel.values.size() + channel.moments.size();
  });
  promise(values <= file.size(), "a value takes a byte of the file at least");
  std::string text;
  (void)is_taken<std::invalid_argument>([&] { text = bench::tdms_text(file, "fuzz.tdms").text; });
  constexpr std::size_t most_of_a_byte = 60;  // a value and its time
  promise(text.size() <= most_of_a_byte * file.size(), "the text grows with the file alone");
}

const Registered registered("tdms", fuzz_tdms);

}  // namespace
}  // namespace kerf::fuzz
