#pragma once

#include <future>
#include <map>
#include <mutex>
#include <string>

#include "regress/suite.h"

namespace kerf::bench {

/// What commands for a version print, each asked once, however many cases have it and on whatever thread.
class AskedVersions {
 public:
  /// @throws std::invalid_argument if it cannot be asked for, to all who ask.
  [[nodiscard]] std::string of(const OutsideRenderer& renderer);

 private:
  std::mutex guard_;
  std::map<std::string, std::shared_future<std::string>> all_;
};

/// What forces are made with as far as it is seen, a line each, `what: value`: of a renderer the first line
/// of its version and the SHA-256 of its command and of each file that the command names, the program also
/// where it is found along PATH; of a law its plug-in. Empty of a law of Kerf's own.
/// @throws std::invalid_argument if the version cannot be asked for.
[[nodiscard]] std::string made_with(const RegressionCase& one, AskedVersions& versions);

/// What of it is not as it was, in words: "python3 is another file, its version was '1.0' and is '1.1'";
/// empty if all is, or if nothing is stored.
[[nodiscard]] std::string made_otherwise(const std::string& stored, const std::string& now);

}  // namespace kerf::bench
