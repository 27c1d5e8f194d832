#include "recordings/provenance.h"

#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

// FIPS 180-4: the examples that come with the standard, and nothing at all.
TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(sha256_of(std::string_view("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of(std::string_view("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_of(std::string_view("")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace kerf::bench
