#include "sweeps/sweep_routes.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/sweeps/atlas/merged_walls.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class SweepRoutes : public test::MergedWalls {
 protected:
  SweepRoutes() { add_sweep_routes(routes_, workspace_, sweep_verbs()); }

  HttpResponse ask(HttpRequest request) {
    const auto asker = std::make_shared<int>();
    request.number = ++number_;
    request.asker = asker;
    auto response = routes_.respond(request, false);
    for (; !response; response = routes_.respond(request, false)) std::this_thread::yield();
    return *response;
  }
  HttpResponse get() { return ask({.method = "GET", .path = "/api/sweep", .query = {{"id", id()}}}); }
  HttpResponse post(const std::string& what, json body) {
    body["id"] = id();
    return ask({.method = "POST",
                .path = "/api/sweep/" + what,
                .headers = {{"content-type", "application/json"}},
                .body = body.dump()});
  }
  [[nodiscard]] std::string id() const { return workspace_.id_of(file("w.merged/sweep.h5")); }
  /// The energy is the number of the cell and `more`; the last cell is missing.
  void merge(double more = 0.0) {
    merged(first(19),
           [more](std::size_t cell) { return Numbers{.energy = static_cast<double>(cell) + more}; });
  }

  Workspace workspace_{folder_.path()};
  Routes routes_;
  std::uint64_t number_ = 0;
};

TEST_F(SweepRoutes, TellTheColumnsOfEveryTable) {
  merge();
  const json sweep = json::parse(get().body);
  EXPECT_EQ(sweep["verb"], "stability");
  EXPECT_EQ(sweep["cells"], 20);
  const json& table = sweep["tables"].at(0);
  EXPECT_EQ(table["computed"], 19);
  EXPECT_EQ(table["missing"], 1);
  EXPECT_EQ(table["columns"].at(0)["name"], "mass");
  EXPECT_EQ(table["columns"].at(0)["unit"], "kg");
  EXPECT_EQ(table["columns"].at(0)["texts"], json({"0.05", "0.1"}));
  EXPECT_EQ(table["columns"].back()["input"], false);
}

TEST_F(SweepRoutes, AnswerWithValuesAndCountsOfEveryTile) {
  merge();
  const HttpResponse response =
      post("answer", {{"table", "walls"}, {"by", {"stiffness", "mass"}}, {"of", "energy"}});
  ASSERT_EQ(response.status, 200) << response.body;
  const json found = json::parse(response.body);
  EXPECT_EQ(found["unit"], "J");
  EXPECT_EQ(found["value"].size(), 20U);
  EXPECT_EQ(found["value"][18], 18);
  EXPECT_TRUE(found["value"][19].is_null());
  EXPECT_EQ(found["missing"][19], 1);
  EXPECT_EQ(found["axes"][0]["logarithmic"], true);
  EXPECT_EQ(found["all"]["known"], 19);
}

TEST_F(SweepRoutes, SampleCellsWithTheirState) {
  merge();
  const HttpResponse response = post("sample", {{"table", "walls"},
                                                {"by", json::array()},
                                                {"of", "energy"},
                                                {"columns", {"mass", "energy"}},
                                                {"most", 100}});
  ASSERT_EQ(response.status, 200) << response.body;
  const json found = json::parse(response.body);
  EXPECT_EQ(found["of"], 20);
  EXPECT_EQ(found["state"][19], "missing");
  EXPECT_EQ(found["values"][0][19], 1) << "the place of 0.1";
  EXPECT_TRUE(found["values"][1][19].is_null());
}

TEST_F(SweepRoutes, SeeASweepThatWasMergedAnew) {
  merge();
  const json question{{"table", "walls"}, {"by", json::array()}, {"of", "energy"}};
  EXPECT_EQ(json::parse(post("answer", question).body)["value"][0], 9);
  merge(10.0);
  std::filesystem::last_write_time(file("w.merged/sweep.h5"),
                                   std::filesystem::file_time_type::clock::now() + std::chrono::seconds(60));
  EXPECT_EQ(json::parse(post("answer", question).body)["value"][0], 19);
}

TEST_F(SweepRoutes, RefuseInALine) {
  merge();
  const HttpResponse response = post("answer", {{"table", "walls"}, {"by", {"colour"}}, {"of", "energy"}});
  EXPECT_EQ(response.status, 400);
  EXPECT_THAT(response.body, HasSubstr("walls has no column 'colour'"));
  EXPECT_EQ(post("answer", {{"table", "walls"}}).status, 400);
  const HttpResponse nothing =
      ask({.method = "GET", .path = "/api/sweep", .query = {{"id", "0123456789abcdef"}}});
  EXPECT_EQ(nothing.status, 404);
  EXPECT_THAT(nothing.body, HasSubstr("there is no such sweep"));
}

}  // namespace
}  // namespace kerf::bench
