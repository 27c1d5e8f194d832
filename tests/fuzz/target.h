#pragma once

#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// A fuzzer is a function of bytes under a name: libFuzzer runs it with bytes of its own making
// (libfuzzer.cpp), the tests with those that are stored (stored_inputs_test.cpp).

namespace kerf::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// What a parser promised and did not keep. No std::exception, so that nobody takes it for a refusal.
struct BrokenPromise {
  std::string what;
};

inline void promise(bool kept, const std::string& what) {
  if (kept) return;
  (void)std::fprintf(stderr, "broken promise: %s\n", what.c_str());
  throw BrokenPromise{what};
}

struct Target {
  const char* name;
  void (*run)(Bytes bytes);
};

/// The fuzzers that are linked into this program.
[[nodiscard]] inline std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

/// Puts a fuzzer among them.
struct Registered {
  Registered(const char* name, void (*run)(Bytes bytes)) { targets().push_back({name, run}); }
};

[[nodiscard]] inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Whether `action` takes its input. It may refuse it by one of these exceptions, with a sentence; anything
/// else goes on.
template <typename... Refusals, typename Action>
[[nodiscard]] bool is_taken(const Action& action) {
  try {
    action();
    return true;
  } catch (const std::exception& error) {
    if (!(... || (dynamic_cast<const Refusals*>(&error) != nullptr))) throw;
    promise(*error.what() != '\0', "who refuses says why");
    return false;
  }
}

}  // namespace kerf::fuzz
