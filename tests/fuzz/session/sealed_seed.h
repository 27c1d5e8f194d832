#pragma once

#include <string>

#include "bench/sessions/sealed/stored_session.h"
#include "files/whole_file.h"
#include "sealed/journal.h"

namespace kerf::fuzz {

/// A session that was left in its run: one answer is in the file, two are in its journal.
class SealedSeed {
 public:
  SealedSeed() {
    {
      bench::SessionStore first = stored_.run();
      first.append(test::answered(first.plan()[0], 1));
      first.close();
    }
    bench::SessionStore second = stored_.run();
    second.append(test::answered(second.plan()[1], 0));
    second.append(test::answered(second.plan()[2], 1));
    file_ = bench::read_whole_file(stored_.file());
    journal_ = bench::read_whole_file(bench::journal_of(stored_.file()));
  }

  [[nodiscard]] const test::StoredSession& stored() const { return stored_; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::string& journal() const { return journal_; }
  /// The answers as they were given.
  static constexpr std::size_t answers[] = {1, 0, 1};

 private:
  test::StoredSession stored_;
  std::string file_;
  std::string journal_;
};

[[nodiscard]] inline const SealedSeed& sealed_seed() {
  static const SealedSeed seed;
  return seed;
}

}  // namespace kerf::fuzz
