#include <algorithm>
#include <string_view>

#include <kerf/drivers/protocols/woody_v4.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

using namespace drivers;

/// Whatever comes from the line, in pieces: an answer is one that the firmware could have written.
void fuzz_woody_v4(Bytes bytes) {
  // NOLINTNEXTLINE(*-reinterpret-cast): bytes of a line are text here
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  woody_v4::AnswerReader reader;
  const std::size_t piece = 1 + rest.size() / 3;
  std::size_t taken = 0;
  while (!rest.empty()) {
    reader.add(rest.substr(0, piece));
    rest.remove_prefix(std::min(piece, rest.size()));
    while (const auto text = reader.next()) {
      taken += text->size();
      promise(text->ends_with(']'), "an answer has its end");
      const auto answer = woody_v4::parse(*text);
      if (!answer) continue;
      promise(std::ranges::count(*text, ',') == 7, "an answer has eight numbers");
      promise(answer->error == 0 || (answer->error & (woody_v4::not_taken | 7)) == 0 ||
                  !woody_v4::in_words(answer->error).empty(),
              "what is wrong has words");
    }
  }
  promise(taken <= bytes.size(), "a byte is of one answer");
}

const Registered registered("woody_v4", fuzz_woody_v4);

}  // namespace
}  // namespace kerf::fuzz
