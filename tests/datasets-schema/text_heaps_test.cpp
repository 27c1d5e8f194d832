#include "hdf5/text_heaps.h"

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::schema {
namespace {

/// HDF5 file format specification, III.E: the head of a heap of 48 bytes, one object that claims `length`,
/// the free rest.
std::string heap_with_an_object_of(char length) {
  using namespace std::string_literals;
  const std::string head = "GCOL\1\0\0\0"s + "\x30\0\0\0\0\0\0\0"s;
  const std::string object = "\1\0\1\0\0\0\0\0"s + std::string(1, length) + "\0\0\0\0\0\0\0"s + "sixteen!"s;
  return head + object + std::string(8, '\0');
}

TEST(TextHeaps, AreLookedThroughWhereverTheyBegin) {
  const test::TemporaryFolder folder;
  constexpr std::size_t piece = std::size_t{256} << 10U;  // what is read at once
  for (const std::size_t begin : {std::size_t{0}, std::size_t{7}, piece - 3, piece, 2 * piece - 7}) {
    const auto is_sound = [&](char length) {
      test::write_text(folder / "heap", std::string(begin, 'x') + heap_with_an_object_of(length));
      return are_text_heaps_sound(folder / "heap");
    };
    EXPECT_TRUE(is_sound(8)) << begin;
    EXPECT_FALSE(is_sound(100)) << begin << ": an object that is longer than its heap";
  }
}

TEST(TextHeaps, AreFoundBehindHoles) {
  const test::TemporaryFolder folder;
  constexpr std::size_t page = 4096;
  constexpr std::size_t behind = std::size_t{40} << 20U;
  test::write_text(folder / "heap", std::string(page, 'x') + heap_with_an_object_of(8));
  std::filesystem::resize_file(folder / "heap", behind);
  EXPECT_TRUE(are_text_heaps_sound(folder / "heap", page));
  std::ofstream(folder / "heap", std::ios::binary | std::ios::app) << heap_with_an_object_of(100);
  EXPECT_FALSE(are_text_heaps_sound(folder / "heap", page));
  std::filesystem::resize_file(folder / "heap", 2 * behind);
  EXPECT_FALSE(are_text_heaps_sound(folder / "heap", page));
}

}  // namespace
}  // namespace kerf::schema
