#include <kerf/schema/recording.h>
#include <kerf/schema/session.h>

#include "fuzz/overwritten.h"
#include "fuzz/scratch_folder.h"
#include "fuzz/session/sealed_seed.h"
#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

const schema::Session& session() {
  static const schema::Session read = schema::read_session(sealed_seed().stored().file());
  return read;
}

/// A journal with pieces overwritten, or, if the first byte is odd, what follows instead of one: damaged, or
/// each of its entries can be read.
void fuzz_journal(Bytes bytes) {
  if (bytes.empty()) return;
  static const ScratchFolder folder;
  const Bytes rest = bytes.subspan(1);
  const bool is_new = bytes.front() % 2 == 1;
  const auto file = folder.write(
      "s.h5.journal", is_new ? std::string(text_of(rest)) : overwritten(sealed_seed().journal(), rest));
  auto journal = bench::Journal::look(folder.path() / "s.h5");
  promise(journal.has_value(), "a journal that is there is found");
  if (!is_taken<schema::FormatError>([&] { journal->take_up(session()); })) return;
  std::size_t bytes_of_entries = 0;
  for (std::size_t i = 0; i < journal->entries().size(); ++i)
    bytes_of_entries += journal->read_sealed(i).size();
  promise(bytes_of_entries <= std::filesystem::file_size(file), "entries hold what the file holds");
}

const Registered registered("journal", fuzz_journal);

}  // namespace
}  // namespace kerf::fuzz
