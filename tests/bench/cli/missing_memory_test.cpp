#include "program/missing_memory.h"

#include <cstddef>
#include <limits>
#include <new>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace kerf::bench {
namespace {

constexpr auto more_than_there_is = std::numeric_limits<std::size_t>::max() / 4;

/// As a destructor of another's library does.
void take_too_much() noexcept { ::operator delete(::operator new(more_than_there_is)); }

TEST(MissingMemoryDeathTest, EndsWithALineWhereNobodyMayThrow) {
  EXPECT_EXIT((end_where_memory_is_missing(), take_too_much()), testing::ExitedWithCode(4),
              "^kerf: there is no memory\n$");
}

TEST(MissingMemoryDeathTest, CanStillBeCaught) {
  const auto catch_it = [] {
    end_where_memory_is_missing();
    try {
      ::operator delete(::operator new(more_than_there_is));
    } catch (const std::bad_alloc&) {
      _exit(0);
    }
  };
  EXPECT_EXIT(catch_it(), testing::ExitedWithCode(0), "");
}

TEST(MissingMemoryDeathTest, IsNotBlamedForWhatElseEndsTheProgram) {
  const auto fail = []() noexcept { (void)std::string().at(1); };
  EXPECT_DEATH((end_where_memory_is_missing(), fail()), "terminate");
}

}  // namespace
}  // namespace kerf::bench
