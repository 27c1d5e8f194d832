#include "editor/editor_routes.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "editor/segment_editor.h"
#include "recordings/provenance.h"
#include "segment/segment.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

/// Scissors on a spring of 4 N/rad, with 0.5 N more while closing.
schema::Recording cutting(double stiffness = 4.0) {
  schema::Recording recording;
  recording.header = schema::new_header("test");
  recording.axes = {{.name = "theta", .position_unit = "rad"}};
  for (int row = 0; row < 4000; ++row) {
    const double phase = std::numbers::pi * row / 500.0;
    const double x = 0.25 * (1.0 - std::cos(phase));
    recording.time.push_back(1e-3 * row);
    recording.tick.push_back(static_cast<std::uint64_t>(row));
    recording.position.push_back(0.1 + x);
    recording.velocity.push_back(250.0 * std::numbers::pi / 500.0 * std::sin(phase));
    recording.force_measured.push_back(stiffness * x + (row / 500 % 2 == 0 ? 0.5 : 0.0));
  }
  return recording;
}

class EditorRoutes : public testing::Test {
 protected:
  void SetUp() override {
    write(cutting());
    id_ = workspace_.id_of(folder_ / "cut.h5");
    add_editor_routes(routes_, workspace_, [this](const LawFile& law) {
      if (!loop_runs_) throw RequestError(409, "no loop is running");
      felt_.push_back(law);
    });
  }

  void write(schema::Recording recording) {
    recording.cycles = find_cycles(recording, {});
    schema::write_recording(folder_ / "cut.h5", recording);
  }

  HttpResponse answer(HttpRequest request) {
    const auto asker = std::make_shared<int>();
    request.number = ++number_;
    request.asker = asker;
    auto response = routes_.respond(request, false);
    while (!response) {
      std::this_thread::yield();
      response = routes_.respond(request, false);
    }
    return *response;
  }
  HttpResponse curve(const std::string& id, const std::string& axis = "0") {
    return answer({.method = "GET", .path = "/api/editor/curve", .query = {{"id", id}, {"axis", axis}}});
  }
  HttpResponse post(const std::string& what, const Json& body) {
    return answer({.method = "POST",
                   .path = "/api/editor/" + what,
                   .headers = {{"content-type", "application/json"}},
                   .body = body.dump()});
  }
  /// The spring, with the 0.5 N as drawn, as `off` more.
  [[nodiscard]] Json asked(double off = 0.0) const {
    return {{"recording", id_},
            {"axis", 0},
            {"knots",
             {{"penetration", {0.0, 0.2, 0.5}},
              {"closing", {0.5 + off, 1.3 + off, 2.5 + off}},
              {"opening", {0.0, 0.8, 2.0}}}}};
  }

  test::TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  std::string id_;
  bool loop_runs_ = true;
  std::vector<LawFile> felt_;
  std::uint64_t number_ = 0;
  Routes routes_;
};

TEST_F(EditorRoutes, TellTheCurveWithGapsAsNull) {
  const Json json = Json::parse(curve(id_).body);
  EXPECT_EQ(json["recording"], id_);
  EXPECT_EQ(json["axis"], "theta");
  EXPECT_EQ(json["force_unit"], "N");
  EXPECT_EQ(json["cycles"], 4);
  EXPECT_EQ(json["segmented_here"], false);
  EXPECT_EQ(json["closing_direction"], 1.0);
  EXPECT_NEAR(json["contact_position"].get<double>(), 0.1, 1e-4);
  ASSERT_EQ(json["penetration"].size(), 101U);
  EXPECT_NEAR(json["closing"][50].get<double>(), 0.5 + 4.0 * json["penetration"][50].get<double>(), 0.02);
  EXPECT_TRUE(json["closing"].back().is_null() || json["closing"].back().is_number());
  EXPECT_TRUE(json["closing"].front().is_null()) << "turning round, not closing";
  EXPECT_EQ(json["jnd"]["threshold_n"], 0.05);
}

TEST_F(EditorRoutes, RefuseWhatIsNotThere) {
  EXPECT_EQ(curve("0123456789abcdef").status, 404);
  EXPECT_EQ(curve(id_, "1").status, 400);
  EXPECT_EQ(curve(id_, "x").status, 400);
  EXPECT_EQ(answer({.method = "GET", .path = "/api/editor/curve"}).status, 400);
}

TEST_F(EditorRoutes, SeeThatTheFileHasChanged) {
  const Json before = Json::parse(post("error", asked()).body);
  EXPECT_LT(before["rmse_n"].get<double>(), 0.05);
  write(cutting(8.0));
  fs::last_write_time(folder_ / "cut.h5", fs::file_time_type::clock::now() + std::chrono::seconds(2));
  EXPECT_GT(Json::parse(post("error", asked()).body)["rmse_n"].get<double>(), 0.5);
}

TEST_F(EditorRoutes, TellTheErrorAndWhatIsBest) {
  EXPECT_NEAR(Json::parse(post("error", asked(0.3)).body)["worst_n"].get<double>(), 0.3, 0.05);
  const Json best =
      Json::parse(post("best", {{"recording", id_}, {"axis", 0}, {"segments", 3}, {"loop", true}}).body);
  EXPECT_EQ(best["knots"]["penetration"].size(), 4U);
  EXPECT_EQ(best["knots"]["opening"].size(), 4U);
  EXPECT_LT(best["error"]["rmse_n"].get<double>(), 0.02);
  const Json forces = Json::parse(post("forces", asked(0.3)).body);
  EXPECT_EQ(forces["knots"]["penetration"], asked()["knots"]["penetration"]);
  EXPECT_NEAR(forces["knots"]["closing"][1].get<double>(), 1.3, 0.02);
}

TEST_F(EditorRoutes, SaveALawThatCanBeReadAgainAndGoneOnWith) {
  Json law = asked();
  law["name"] = "drawn";
  law["replace"] = false;
  const HttpResponse saved = post("save", law);
  ASSERT_EQ(saved.status, 200) << saved.body;
  const Json json = Json::parse(saved.body);
  EXPECT_EQ(json["name"], "drawn.law.toml");
  EXPECT_EQ(json["error"], Json::parse(post("error", asked()).body));
  const LawFile file = read_law_file(folder_ / "drawn.law.toml");
  EXPECT_EQ(file.law.model(), "piecewise");
  EXPECT_EQ(file.fit.recording_sha256, sha256_of(folder_ / "cut.h5"));
  EXPECT_TRUE(file.law.options().contains("ramp_band"));
  const Json again = Json::parse(
      answer({.method = "GET", .path = "/api/editor/law", .query = {{"id", json["id"].get<std::string>()}}})
          .body);
  for (const char* part : {"penetration", "closing", "opening"}) EXPECT_EQ(again[part], law["knots"][part]);
  EXPECT_EQ(again["contact_position"], file.contact.position);
  EXPECT_EQ(again["closing_direction"], 1.0);
}

TEST_F(EditorRoutes, ReplaceALawOnlyWhereThatIsAskedFor) {
  Json law = asked();
  law["name"] = "drawn";
  EXPECT_EQ(post("save", law).status, 200);
  law["knots"]["closing"] = {9.0, 9.0, 9.0};
  EXPECT_EQ(post("save", law).status, 409);
  EXPECT_EQ(knots_of(read_law_file(folder_ / "drawn.law.toml")).closing[0], 0.5);
  law["replace"] = true;
  EXPECT_EQ(post("save", law).status, 200);
  EXPECT_EQ(knots_of(read_law_file(folder_ / "drawn.law.toml")).closing[0], 9.0);
}

TEST_F(EditorRoutes, RefuseBadBreakpointsAndNames) {
  Json law = asked();
  law["name"] = "../drawn";
  EXPECT_EQ(post("save", law).status, 400);
  law["name"] = "drawn";
  law["knots"]["penetration"] = {0.0, 0.5, 0.2};
  const HttpResponse refused = post("save", law);
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("breakpoint 3 at 0.2 must be deeper"));
  EXPECT_FALSE(fs::exists(folder_ / "drawn.law.toml"));
  law["knots"]["penetration"] = {0.0, nullptr, 0.2};
  EXPECT_EQ(post("error", law).status, 400);
  law.erase("knots");
  for (const char* what : {"error", "forces", "save", "feel"}) EXPECT_EQ(post(what, law).status, 400) << what;
  EXPECT_EQ(post("best", {{"recording", id_}, {"axis", 0}, {"segments", 0}, {"loop", true}}).status, 400);
}

TEST_F(EditorRoutes, TakeBreakpointsOfPiecewiseLawsAlone) {
  const LawFile other{.law = models::Law::make("exponential", std::vector<double>{1.0, 100.0, 0.0})};
  write_law_file(folder_ / "other.law.toml", other);
  const HttpResponse refused = answer({.method = "GET",
                                       .path = "/api/editor/law",
                                       .query = {{"id", workspace_.id_of(folder_ / "other.law.toml")}}});
  EXPECT_EQ(refused.status, 400);
  EXPECT_THAT(refused.body, HasSubstr("'exponential' has no breakpoints"));
}

TEST_F(EditorRoutes, FeelTheLawAsItWouldBeSaved) {
  ASSERT_EQ(post("feel", asked()).status, 200);
  ASSERT_EQ(felt_.size(), 1U);
  EXPECT_EQ(felt_[0].axis, "theta");
  EXPECT_EQ(knots_of(felt_[0]).closing[1], 1.3);
  EXPECT_TRUE(felt_[0].law.options().contains("ramp_band"));
  loop_runs_ = false;
  const HttpResponse refused = post("feel", asked());
  EXPECT_EQ(refused.status, 409);
  EXPECT_THAT(refused.body, HasSubstr("no loop is running"));
}

}  // namespace
}  // namespace kerf::bench
