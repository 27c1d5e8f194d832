#include <fstream>
#include <stdexcept>
#include <system_error>

#include "fuzz/overwritten.h"
#include "fuzz/session/sealed_seed.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes;
}

/// A sealed session with pieces overwritten, of its file or, if the first byte is odd, of its journal. Who
/// has the key is refused, or reads answers as they were given: all of them, or the first.
void fuzz_session(Bytes bytes) {
  if (bytes.empty()) return;
  const SealedSeed& seed = sealed_seed();
  const bool in_journal = bytes.front() % 2 == 1;
  const Bytes pieces = bytes.subspan(1);
  const auto& file = seed.stored().file();
  write(file, in_journal ? seed.file() : overwritten(seed.file(), pieces));
  write(bench::journal_of(file), in_journal ? overwritten(seed.journal(), pieces) : seed.journal());
  (void)is_taken<std::invalid_argument, schema::FormatError, std::system_error>([&] {
    const bench::SessionStore store = seed.stored().read();
    promise(store.trials().size() <= std::size(SealedSeed::answers), "nobody adds an answer");
    for (std::size_t i = 0; i < store.trials().size(); ++i)
      promise(store.trial(i).answer == SealedSeed::answers[i], "an answer is the one that was given");
    (void)bench::study_of({&store});
  });
}

const Registered registered("session", fuzz_session);

}  // namespace
}  // namespace kerf::fuzz
