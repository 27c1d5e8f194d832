#include "sealed/seal.h"

#include <set>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "bench/sessions/sealed/sealed_session.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::vector<std::uint8_t> in(const SealKey& key) { return {key.bytes().begin(), key.bytes().end()}; }

schema::KeyDerivation cheap() {
  return {.kind = "passphrase", .salt = {1, 2, 3}, .operations = 1, .memory_bytes = 8192};
}

TEST(SealKey, IsTheSameForTheSameFileAndSalt) {
  EXPECT_EQ(in(test::key_of('a')), in(test::key_of('a')));
  EXPECT_NE(in(test::key_of('a')), in(test::key_of('b')));
  EXPECT_NE(in(test::key_of('a')), in(test::key_of('a', {.salt = {1}})));
}

// BLAKE2b-256 with salt and personalisation, by Python's hashlib.
TEST(SealKey, OfAFileIsBlake2b) {
  constexpr std::array<std::uint8_t, 4> first{0xa5, 0x1e, 0x08, 0x51};
  const auto key = in(test::key_of('k'));
  EXPECT_TRUE(std::equal(first.begin(), first.end(), key.begin()))
      << fmt::format("{:02x}", fmt::join(key, ""));
}

TEST(SealKey, OfAPassphraseDependsOnSaltAndCosts) {
  const auto key = in(SealKey::from_passphrase("four words that nobody", cheap()));
  EXPECT_EQ(key, in(SealKey::from_passphrase("four words that nobody", cheap())));
  EXPECT_NE(key, in(SealKey::from_passphrase("four words that somebody", cheap())));
  auto other = cheap();
  other.salt[15] = 1;
  EXPECT_NE(key, in(SealKey::from_passphrase("four words that nobody", other)));
  other = cheap();
  other.operations = 2;
  EXPECT_NE(key, in(SealKey::from_passphrase("four words that nobody", other)));
}

TEST(SealKey, RefusesCostsThatWouldExhaustTheMachine) {
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 31U, UINT64_MAX}) {
    auto absurd = cheap();
    absurd.memory_bytes = memory;
    EXPECT_THAT([&] { (void)SealKey::from_passphrase("a passphrase", absurd); },
                ThrowsMessage<std::invalid_argument>(HasSubstr("the file was changed")));
  }
  auto absurd = cheap();
  absurd.operations = 1U << 20U;
  EXPECT_THROW((void)SealKey::from_passphrase("a passphrase", absurd), std::invalid_argument);
}

TEST(SealKey, OfTheOtherKindIsRefused) {
  EXPECT_THAT(
      [] { (void)SealKey::from_passphrase("a passphrase", {}); },
      ThrowsMessage<std::invalid_argument>("the session was sealed with a key file; this is a passphrase"));
  EXPECT_THROW((void)test::key_of('a', cheap()), std::invalid_argument);
}

TEST(SealKey, TakesFilesOf32BytesTo1MiB) {
  const kerf::test::TemporaryFolder folder;
  for (const auto& [size, fits] :
       {std::pair{0U, false}, {31U, false}, {32U, true}, {1U << 20U, true}, {(1U << 20U) + 1, false}}) {
    kerf::test::write_text(folder / "key", std::string(size, 'x'));
    if (fits) {
      EXPECT_NO_THROW((void)SealKey::from_file(folder / "key", {})) << size;
    } else {
      EXPECT_THAT(
          [&] { (void)SealKey::from_file(folder / "key", {}); },
          ThrowsMessage<std::invalid_argument>(HasSubstr("expected a key file of 32 bytes to 1 MiB")));
    }
  }
  EXPECT_THROW((void)SealKey::from_file(folder / "none", {}), std::invalid_argument);
  EXPECT_THROW((void)SealKey::from_file(folder.path(), {}), std::invalid_argument);
}

TEST(SealKey, ThatIsCopiedOutlivesItsOriginal) {
  auto original = std::make_unique<SealKey>(test::key_of('a'));
  const auto bytes = in(*original);
  const SealKey copy = original->copy();
  const SealKey moved = std::move(*original);
  original.reset();
  EXPECT_EQ(in(copy), bytes);
  EXPECT_EQ(in(moved), bytes);
}

TEST(NewKeyFile, BelongsToItsOwnerAndIsNeverReplaced) {
  const kerf::test::TemporaryFolder folder;
  write_new_key_file(folder / "key");
  struct stat status {};
  ASSERT_EQ(::stat((folder / "key").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_EQ(status.st_size, 32);
  const std::string content = kerf::test::read_text(folder / "key");
  EXPECT_THAT([&] { write_new_key_file(folder / "key"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a key is never replaced")));
  EXPECT_EQ(kerf::test::read_text(folder / "key"), content);
  write_new_key_file(folder / "other");
  EXPECT_NE(kerf::test::read_text(folder / "other"), content);
  EXPECT_THROW(write_new_key_file(folder / "no" / "key"), std::system_error);
}

TEST(NewKeyFile, LeavesNothingOnAFullDisk) {
  const kerf::test::TemporaryFolder folder;
  {
    const kerf::test::FullDisk disk(8);
    EXPECT_THROW(write_new_key_file(folder / "key"), std::system_error);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(NewKeyFile, HasItsNameOnlyWhenItIsWhole) {
  const kerf::test::TemporaryFolder folder;
  const auto dies_after_8_bytes = [&] {
    const kerf::test::FullDisk disk(8);
    std::signal(SIGXFSZ, SIG_DFL);
    write_new_key_file(folder / "key");
  };
  EXPECT_EXIT(dies_after_8_bytes(), testing::KilledBySignal(SIGXFSZ), "");
  EXPECT_FALSE(std::filesystem::exists(folder / "key"));
  write_new_key_file(folder / "key");
  EXPECT_EQ(std::filesystem::file_size(folder / "key"), 32U);
}

TEST(NewDerivation, HasAFreshSaltAndTheCostsOfToday) {
  const auto passphrase = new_derivation(true);
  EXPECT_EQ(passphrase.kind, "passphrase");
  EXPECT_EQ(passphrase.operations, 3U);
  EXPECT_EQ(passphrase.memory_bytes, 256U << 20U);
  const auto file = new_derivation(false);
  EXPECT_EQ(file.kind, "key file");
  EXPECT_EQ(file.operations + file.memory_bytes, 0U);
  EXPECT_NE(file.salt, passphrase.salt);
  EXPECT_NE(random_seed(), random_seed());
}

TEST(NewPassphrase, HasEightCharactersAtLeast) {
  EXPECT_NO_THROW(require_long_enough("abcdefgh"));
  EXPECT_NO_THROW(require_long_enough("äöüäöüäö"));
  EXPECT_THAT([] { require_long_enough("äöüäöüä"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("has 7 characters; expected 8 at least")));
}

TEST(Seal, OpensWithTheSameKeyAndTheSameWords) {
  const SealKey key = test::key_of('a');
  for (const std::size_t size : {0U, 1U, 100'000U}) {
    const std::vector<std::uint8_t> content(size, 7);
    const auto box = sealed(key, content, "bound");
    EXPECT_EQ(box.size(), size + 40);
    EXPECT_EQ(unsealed(key, box, "bound"), content);
    EXPECT_THROW((void)unsealed(key, box, "bounds"), std::invalid_argument);
    EXPECT_THROW((void)unsealed(test::key_of('b'), box, "bound"), std::invalid_argument);
  }
}

TEST(Seal, BreaksWithEveryBit) {
  const SealKey key = test::key_of('a');
  const auto box = sealed(key, test::bytes_of("which one"), "");
  for (std::size_t bit = 0; bit < 8 * box.size(); ++bit) {
    auto changed = box;
    changed[bit / 8] = static_cast<std::uint8_t>(changed[bit / 8] ^ (1U << bit % 8));
    EXPECT_THROW((void)unsealed(key, changed, ""), std::invalid_argument) << bit;
  }
  for (std::size_t size = 0; size < box.size(); ++size) {
    EXPECT_THROW((void)unsealed(key, std::span(box).first(size), ""), std::invalid_argument) << size;
  }
}

TEST(Seal, NeverLooksTheSameTwice) {
  const SealKey key = test::key_of('a');
  std::set<std::vector<std::uint8_t>> boxes;
  for (int i = 0; i < 100; ++i) boxes.insert(sealed(key, {}, ""));
  EXPECT_EQ(boxes.size(), 100U);
}

}  // namespace
}  // namespace kerf::bench
