#include "intake/uploads.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "http/routes.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

/// What is answered: the status and the sentence of a refusal, or 200.
template <typename Work>
std::pair<int, std::string> answer_of(const Work& work) {
  try {
    (void)work();
  } catch (const RequestError& refused) {
    return {refused.status, refused.what()};
  }
  return {200, ""};
}

TEST(Uploads, PutPiecesTogether) {
  const test::TemporaryFolder folder;
  Uploads uploads(folder.path());
  const Upload begun = uploads.begin("9.txt", 10, 7);
  EXPECT_EQ(begun.have, 0U);
  EXPECT_EQ(uploads.append(begun.id, 0, "01234").have, 5U);
  EXPECT_FALSE(uploads.find(begun.id).is_whole());
  EXPECT_EQ(uploads.append(begun.id, 5, "56789").have, 10U);
  EXPECT_TRUE(uploads.find(begun.id).is_whole());
  EXPECT_EQ(test::read_text(uploads.find(begun.id).data()), "0123456789");
  EXPECT_EQ(uploads.find(begun.id).data().filename(), "9.txt") << "recordings name what they were made of";
}

TEST(Uploads, GoOnWhereTheyStopped) {
  const test::TemporaryFolder folder;
  std::string id;
  {
    Uploads uploads(folder.path());
    id = uploads.begin("9.txt", 10, 7).id;
    (void)uploads.append(id, 0, "0123");
  }
  Uploads another(folder.path());  // of a studio that was started anew
  const Upload again = another.begin("9.txt", 10, 7);
  EXPECT_EQ(again.id, id);
  EXPECT_EQ(again.have, 4U);
  EXPECT_EQ(another.all().size(), 1U);
  EXPECT_NE(another.begin("9.txt", 10, 8).id, id) << "a file that was changed since is another one";
  EXPECT_NE(another.begin("8.txt", 10, 7).id, id);
}

TEST(Uploads, RefuseAPieceThatDoesNotFollow) {
  const test::TemporaryFolder folder;
  Uploads uploads(folder.path());
  const std::string id = uploads.begin("9.txt", 10, 7).id;
  (void)uploads.append(id, 0, "0123");
  EXPECT_EQ(answer_of([&] { return uploads.append(id, 0, "0123"); }).first, 409) << "another tab has sent it";
  EXPECT_EQ(answer_of([&] { return uploads.append(id, 5, "5"); }).first, 409);
  EXPECT_EQ(answer_of([&] { return uploads.append(id, 4, "4567890"); }).first, 413);
  EXPECT_EQ(uploads.find(id).have, 4U) << "nothing of it is kept";
  EXPECT_EQ(answer_of([&] { return uploads.append("../../../../etc", 0, "x"); }).first, 404);
}

TEST(Uploads, TakeEveryNameThatAFileCanHave) {
  const test::TemporaryFolder folder;
  Uploads uploads(folder.path());
  for (const std::string name : {"Schnitt 3 (Süd).csv", "a\"b'c`$(rm).txt", "two\nlines", "-o", "..x",
                                 ".hidden", "切.txt", "about.json", "%2e%2e%2f"}) {
    const Upload upload = uploads.begin(name, 1, 0);
    EXPECT_EQ(uploads.append(upload.id, 0, "1").name, name);
    EXPECT_EQ(upload.data().filename(), name);
  }
  for (const std::string& name : {std::string("a/b"), std::string("."), std::string(".."), std::string(),
                                  std::string(256, 'x'), std::string("a\0b", 3)})
    EXPECT_EQ(answer_of([&] { return uploads.begin(name, 1, 0); }).first, 400) << name;
}

TEST(Uploads, RefuseWhatIsTooLargeOrEmptyBeforeAnythingComes) {
  const test::TemporaryFolder folder;
  Uploads uploads(folder.path());
  const auto [status, why] = answer_of([&] { return uploads.begin("long.csv", Uploads::largest + 1, 0); });
  EXPECT_EQ(status, 413);
  EXPECT_THAT(why, HasSubstr("long.csv"));
  EXPECT_THAT(why, HasSubstr("kerf import"));
  EXPECT_EQ(answer_of([&] { return uploads.begin("empty.csv", 0, 0); }).first, 400);
  EXPECT_TRUE(uploads.all().empty());
}

TEST(Uploads, AreForgottenWithAllThatCame) {
  const test::TemporaryFolder folder;
  Uploads uploads(folder.path());
  const std::string id = uploads.begin("9.txt", 10, 7).id;
  uploads.forget(id);
  uploads.forget("../x");
  EXPECT_EQ(answer_of([&] { return uploads.find(id); }).first, 404);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "nothing is left in the workspace";
}

TEST(Uploads, AreCalledInMessagesAsThePersonKnowsThem) {
  const test::TemporaryFolder folder;
  Uploads uploads(folder.path());
  const Upload upload = uploads.begin("9.txt", 10, 7);
  EXPECT_EQ(as_named(upload.data().string() + ":3: a line\nand more of " + upload.head().string(), upload),
            "9.txt:3: a line and more of 9.txt");
}

}  // namespace
}  // namespace kerf::bench
