#include "verbs/verb_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "http/routes.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

class VerbOrders : public testing::Test {
 protected:
  VerbOrders() {
    for (const char* const name : {"cut.h5", "-o.h5", "a.law.toml", "keeper.key"})
      test::write_text(folder_ / name, "");
    fs::create_directory(folder_ / "fits");
    fs::create_symlink("/etc/passwd", folder_ / "link.h5");
  }

  VerbOrder order(const json& values) { return verb_order(form_, values, workspace_); }
  std::string refusal(const json& values, int status = 400) {
    try {
      return fmt_words(order(values));
    } catch (const RequestError& error) {
      EXPECT_EQ(error.status, status) << error.what();
      return error.what();
    }
  }
  static std::string fmt_words(const VerbOrder& order) { return "taken: " + as_typed(order.words); }

  VerbForm form_{
      .verb = "session simulate",
      .title = "",
      .group = "",
      .description = "",
      .more = "",
      .values = {{.name = "RECORDING",
                  .label = "",
                  .kind = ValueKind::file,
                  .words = {".h5"},
                  .positional = true,
                  .required = true},
                 {.name = "--bias", .label = "", .kind = ValueKind::flag},
                 {.name = "--sigmas", .label = "", .kind = ValueKind::number},
                 {.name = "--filter", .label = "", .kind = ValueKind::text},
                 {.name = "--frame", .label = "", .kind = ValueKind::choice, .words = {"sensor", "base"}},
                 {.name = "--through",
                  .label = "",
                  .kind = ValueKind::file,
                  .words = {".law.toml"},
                  .repeated = true},
                 {.name = "--fits", .label = "", .kind = ValueKind::folder},
                 {.name = "--device", .label = "", .kind = ValueKind::device},
                 {.name = "--output", .label = "", .kind = ValueKind::output, .words = {".csv", ".mat"}}},
      .fixed = {"--virtual"}};
  TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
};

TEST_F(VerbOrders, BecomeTheCommandLineThatAPersonWouldType) {
  const VerbOrder made = order({{"--output", "clean"},
                                {"--sigmas", 2.5},
                                {"RECORDING", "cut.h5"},
                                {"--bias", true},
                                {"--filter", "butterworth2:20"},
                                {"--through", {"a.law.toml"}},
                                {"--fits", "fits"}});
  EXPECT_THAT(made.words, ElementsAre("session", "simulate", "--virtual", "cut.h5", "--bias", "--sigmas=2.5",
                                      "--filter=butterworth2:20", "--through=a.law.toml", "--fits=fits",
                                      "--output=clean.csv"));
  EXPECT_THAT(made.outputs, ElementsAre("clean.csv"));
  EXPECT_THAT(order({{"RECORDING", "cut.h5"}, {"--output", "clean.mat"}, {"--bias", false}}).words,
              ElementsAre("session", "simulate", "--virtual", "cut.h5", "--output=clean.mat"));
}

TEST_F(VerbOrders, GiveAnOptionAsManyNumbersAsItTakes) {
  const std::vector<std::string> words = order({{"RECORDING", "cut.h5"}, {"--sigmas", "5 -2e3"}}).words;
  EXPECT_EQ(as_typed(words), "session simulate --virtual cut.h5 --sigmas=5 -2e3");
  for (const char* const text : {"5  2", "5 x", " 5", "5 ", "nan", "inf", "5,2"})
    EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--sigmas", text}}), HasSubstr("is not a number")) << text;
}

TEST_F(VerbOrders, NameNoFileOutsideAndNoneOfAnotherKind) {
  for (const char* const name :
       {"../cut.h5", "/etc/passwd", "link.h5", "gone.h5", "keeper.key", "", "fits/../cut.h5"})
    EXPECT_THAT(refusal({{"RECORDING", name}}), testing::StartsWith("RECORDING: ")) << name;
  for (const char* const name : {"..", "/", "", "cut.h5", "gone"})
    EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--fits", name}}), testing::StartsWith("--fits: "))
        << name;
}

TEST_F(VerbOrders, WriteNewNamesInTheFolderAlone) {
  for (const char* const name : {"../out", "/tmp/out", ".hidden", "-x", "a/b", ""})
    EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--output", name}}), testing::StartsWith("--output: "))
        << name;
  test::write_text(folder_ / "there.csv", "");
  EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--output", "there"}}, 409), HasSubstr("is there already"));
}

TEST_F(VerbOrders, TakeNothingForAnOption) {
  EXPECT_THAT(order({{"RECORDING", "-o.h5"}}).words.back(), "./-o.h5");
  EXPECT_THAT(order({{"RECORDING", "cut.h5"}, {"--filter", "--force"}}).words.back(), "--filter=--force");
  EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--force", true}}), HasSubstr("has no such value"));
  EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--sigmas", "3 --force"}}), HasSubstr("is not a number"));
  EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--frame", "moon"}}), HasSubstr("sensor, base"));
  EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--filter", "a\x1b[2J"}}), HasSubstr("steers a terminal"));
  EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--bias", "yes"}}), HasSubstr("true or false"));
  EXPECT_THAT(refusal({{"RECORDING", {"cut.h5", "cut.h5"}}}), HasSubstr("takes one value"));
  EXPECT_THAT(refusal(json::object()), HasSubstr("RECORDING: it is needed"));
}

TEST_F(VerbOrders, MoveNoDevice) {
  EXPECT_THAT(order({{"RECORDING", "cut.h5"}, {"--device", "sim:scissors"}}).words.back(),
              "--device=sim:scissors");
  for (const char* const uri : {"falcon:0", "plugin:./x.so", "hapkit:/dev/ttyUSB0"})
    EXPECT_THAT(refusal({{"RECORDING", "cut.h5"}, {"--device", uri}}), HasSubstr("only simulated devices"))
        << uri;
}

TEST(CommandLines, AreShownAsAShellTakesThem) {
  EXPECT_EQ(as_typed({"kerf", "prepare", "my cut.h5", "--filter=it's"}),
            "kerf prepare 'my cut.h5' '--filter=it'\\''s'");
}

}  // namespace
}  // namespace kerf::bench
