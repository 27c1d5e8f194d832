#include "files/file_names.h"

#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(FileNames, KeepLettersOfAnyLanguageAndLeaveNoFolder) {
  EXPECT_EQ(as_file_name("liver 2/b"), "liver_2_b");
  EXPECT_EQ(as_file_name("位移-3.5"), "位移-3.5");
  EXPECT_EQ(as_file_name(".."), "_.");
  const std::string ninety_nine(99, 'a');
  EXPECT_EQ(as_file_name(fmt::format("{}é", ninety_nine)), ninety_nine);
}

TEST(FileNames, AreToldApartByNumbers) {
  NewNames names;
  EXPECT_EQ(names.take("liver"), "liver");
  EXPECT_EQ(names.take("liver"), "liver-2");
  EXPECT_EQ(names.take("liver-2"), "liver-2-2");
  EXPECT_EQ(names.take("liver"), "liver-3");
}

}  // namespace
}  // namespace kerf::bench
