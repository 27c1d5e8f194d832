#include "protocols/protocol_routes.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/studio/server/asker.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryFolder;
using testing::HasSubstr;

std::string abx_of(const std::string& first, const std::string& second) {
  return "name = \"soft or stiff\"\ndesign = \"abx\"\ntrials = 8\npractice = 2\ndevice = \"sim:scissors\"\n"
         "[[sample]]\nname = \"soft\"\nlaw = \"" +
         first + "\"\n[[sample]]\nname = \"stiff\"\nlaw = \"" + second + "\"\n";
}

class ProtocolRoutes : public testing::Test {
 protected:
  ProtocolRoutes() {
    for (const char* const name : {"kelvin", "piecewise"})
      fs::copy_file(fs::path(KERF_SOURCE_DIR) / "examples" / (std::string(name) + ".law.toml"),
                    folder_.path() / (std::string(name) + ".law.toml"));
    add_protocol_routes(routes_, workspace_);
  }

  json checked(const std::string& text) {
    const auto answer = ask_.post("/api/protocol/check", {{"text", text}});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return json::parse(answer.body);
  }
  std::string problem_of(const std::string& text) { return checked(text)["problem"]; }

  TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  Routes routes_;
  test::Asker ask_{routes_};
  const std::string good_ = abx_of("kelvin.law.toml", "piecewise.law.toml");
};

TEST_F(ProtocolRoutes, SayWhatASubjectWouldMeet) {
  const json said = checked(good_);
  EXPECT_EQ(said["problem"], "");
  EXPECT_EQ(said["design"], "abx");
  EXPECT_EQ(said["trials"], 10) << "with the practice";
  EXPECT_EQ(said["question"], "Which one is X?");
  ASSERT_EQ(said["samples"].size(), 2U);
  EXPECT_EQ(said["samples"][1]["law"], "piecewise.law.toml");
}

TEST_F(ProtocolRoutes, SayWhatIsWrongAndWriteNothing) {
  EXPECT_THAT(problem_of("name = \"x\"\ndesign = \"guess\"\n"), HasSubstr(":2:"));
  EXPECT_THAT(problem_of("name = "), HasSubstr(":1:"));
  EXPECT_THAT(problem_of(abx_of("kelvin.law.toml", "gone.law.toml")),
              HasSubstr("there is no file 'gone.law.toml' in this folder"));
  const auto refused = ask_.post("/api/protocol", {{"name", "p"}, {"text", "name = "}});
  EXPECT_EQ(refused.status, 400);
  EXPECT_FALSE(fs::exists(folder_.path() / "p.protocol.toml"));
}

TEST_F(ProtocolRoutes, ReadNothingOutsideTheFolderAndRunNothing) {
  TemporaryFolder other;
  fs::copy_file(folder_.path() / "kelvin.law.toml", other.path() / "kelvin.law.toml");
  fs::create_symlink(other.path() / "kelvin.law.toml", folder_.path() / "link.law.toml");
  test::write_text(folder_.path() / "law.so", "no library");
  const std::string way_up = fs::relative(other.path() / "kelvin.law.toml", folder_.path()).string();
  for (const std::string& law :
       {way_up, (other.path() / "kelvin.law.toml").string(), std::string("link.law.toml")})
    EXPECT_THAT(problem_of(abx_of("kelvin.law.toml", law)), HasSubstr("there is no file")) << law;
  EXPECT_THAT(problem_of(abx_of("kelvin.law.toml", "law.so")), HasSubstr("at a terminal alone"));
}

TEST_F(ProtocolRoutes, WriteANewOneAndReplaceOneThatIsThere) {
  const auto made = ask_.post("/api/protocol", {{"name", "soft"}, {"text", good_}});
  ASSERT_EQ(made.status, 200) << made.body;
  EXPECT_EQ(test::read_text(folder_.path() / "soft.protocol.toml"), good_);
  EXPECT_EQ(ask_.post("/api/protocol", {{"name", "soft"}, {"text", good_}}).status, 409) << "it is there";
  EXPECT_EQ(ask_.post("/api/protocol", {{"name", "../soft"}, {"text", good_}}).status, 400);
  (void)workspace_.scan();
  const std::string id = json::parse(made.body)["id"];
  const std::string more = "# by the page\n" + good_;
  EXPECT_EQ(ask_.post("/api/protocol", {{"id", id}, {"text", more}}).status, 200);
  const json read = json::parse(ask_.get("/api/protocol", {{"id", id}}).body);
  EXPECT_EQ(read["name"], "soft.protocol.toml");
  EXPECT_EQ(read["text"], more);
}

TEST_F(ProtocolRoutes, FindLawsBesideAProtocolInAFolderOfItsOwn) {
  fs::create_directory(folder_.path() / "study");
  test::write_text(folder_.path() / "study/p.protocol.toml",
                   abx_of("../kelvin.law.toml", "../piecewise.law.toml"));
  (void)workspace_.scan();
  const std::string id = workspace_.id_of(folder_.path() / "study/p.protocol.toml");
  const auto answer = ask_.post(
      "/api/protocol/check", {{"id", id}, {"text", abx_of("../kelvin.law.toml", "../piecewise.law.toml")}});
  EXPECT_EQ(json::parse(answer.body)["problem"], "");
}

}  // namespace
}  // namespace kerf::bench
