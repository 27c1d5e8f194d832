#include <algorithm>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fuzz/target.h"
#include "support/program.h"

namespace kerf::fuzz {
namespace {

namespace fs = std::filesystem;

class StoredInputs : public testing::TestWithParam<Target> {};

/// Seeds, and what fuzzers once fell over.
TEST_P(StoredInputs, BreakNoPromise) {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(KERF_SOURCE_DIR "/tests/fuzz/corpus") / GetParam().name))
    files.push_back(entry.path());
  std::ranges::sort(files);
  ASSERT_FALSE(files.empty());
  for (const fs::path& file : files) {
    std::cout << file.filename().string() << std::endl;  // the last is the one that ended the program
    const std::string bytes = test::read_text(file);
    try {
      GetParam().run({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    } catch (const BrokenPromise& promise) {
      ADD_FAILURE() << file << ": " << promise.what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzzers, StoredInputs, testing::ValuesIn(targets()),
                         [](const auto& about) { return std::string(about.param.name); });

}  // namespace
}  // namespace kerf::fuzz
