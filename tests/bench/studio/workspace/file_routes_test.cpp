#include "workspace/file_routes.h"

#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/schema/recording.h>

#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::TemporaryFolder;
using testing::HasSubstr;

class FileRoutes : public testing::Test {
 protected:
  FileRoutes() {
    fs::create_directory(folder_ / "day");
    schema::write_recording(folder_ / "day/cut.h5", test::punch({.seconds = 0.5}));
    add_file_routes(routes_, workspace_);
  }

  HttpResponse answer(HttpRequest request) {
    const auto asker = std::make_shared<int>();
    request.number = ++number_;
    request.asker = asker;
    while (true) {
      if (auto response = routes_.respond(request, false)) return *response;
      std::this_thread::yield();
    }
  }
  HttpResponse post(const std::string& path, const json& body) {
    return answer({.method = "POST",
                   .path = path,
                   .headers = {{"content-type", "application/json"}},
                   .body = body.dump()});
  }
  json trash() { return json::parse(answer({.method = "GET", .path = "/api/trash"}).body); }
  json cut() { return {{"id", workspace_.id_of(folder_ / "day/cut.h5")}, {"kind", "recording"}}; }

  TemporaryFolder folder_;
  Workspace workspace_{folder_.path()};
  Routes routes_;
  std::uint64_t number_ = 0;
};

TEST_F(FileRoutes, WhatIsDeletedCanBeHadBack) {
  const std::string before = test::read_text(folder_ / "day/cut.h5");
  const HttpResponse deleted = post("/api/files/delete", cut());
  ASSERT_EQ(deleted.status, 200) << deleted.body;
  EXPECT_FALSE(fs::exists(folder_ / "day/cut.h5"));
  EXPECT_TRUE(workspace_.scan().empty());
  ASSERT_EQ(trash().size(), 1U);
  EXPECT_EQ(trash()[0]["name"], "day/cut.h5");
  fs::remove(folder_ / "day");
  const json key{{"key", json::parse(deleted.body)["key"]}};
  ASSERT_EQ(post("/api/trash/restore", key).status, 200);
  EXPECT_EQ(test::read_text(folder_ / "day/cut.h5"), before);
  EXPECT_TRUE(trash().empty());
  EXPECT_EQ(post("/api/trash/restore", key).status, 404);
}

TEST_F(FileRoutes, NothingTakesThePlaceOfAnother) {
  const json key{{"key", json::parse(post("/api/files/delete", cut()).body)["key"]}};
  schema::write_recording(folder_ / "day/cut.h5", test::punch({.seconds = 0.2}));
  const HttpResponse back = post("/api/trash/restore", key);
  EXPECT_EQ(back.status, 409);
  EXPECT_THAT(back.body, HasSubstr("is there again"));
  EXPECT_EQ(trash().size(), 1U) << "it stays in the trash";
  schema::write_recording(folder_ / "day/other.h5", test::punch({.seconds = 0.2}));
  json named = cut();
  named["name"] = "other";
  EXPECT_EQ(post("/api/files/rename", named).status, 409);
  EXPECT_EQ(post("/api/trash/empty", json::object()).status, 200);
  EXPECT_TRUE(trash().empty());
}

TEST_F(FileRoutes, ARecordingIsRenamedWhereItIs) {
  json named = cut();
  named["name"] = "first_cut";
  const HttpResponse renamed = post("/api/files/rename", named);
  ASSERT_EQ(renamed.status, 200) << renamed.body;
  EXPECT_EQ(json::parse(renamed.body)["id"], workspace_.id_of(folder_ / "day/first_cut.h5"));
  EXPECT_TRUE(fs::exists(folder_ / "day/first_cut.h5"));
  for (const char* const name : {"../out", "", ".hidden", "a/b"}) {
    json odd{{"id", workspace_.id_of(folder_ / "day/first_cut.h5")}, {"kind", "recording"}, {"name", name}};
    EXPECT_EQ(post("/api/files/rename", odd).status, 400) << name;
  }
}

TEST_F(FileRoutes, ANoteStandsInTheHistoryAndAtItsTime) {
  json note = cut();
  note["text"] = "the blade slipped";
  note["time_s"] = 0.25;
  const std::size_t before = schema::read_recording(folder_ / "day/cut.h5").events.size();
  ASSERT_EQ(post("/api/files/annotate", note).status, 200);
  const schema::Recording read = schema::read_recording(folder_ / "day/cut.h5");
  ASSERT_EQ(read.events.size(), before + 1);
  const auto event = std::ranges::find(read.events, std::string("note"), &schema::Event::kind);
  ASSERT_NE(event, read.events.end());
  EXPECT_EQ(event->text, "the blade slipped");
  EXPECT_EQ(event->time_s, 0.25);
  EXPECT_THAT(read.header.history, HasSubstr("note at 0.25 s: the blade slipped"));
  EXPECT_TRUE(std::ranges::is_sorted(read.events, {}, &schema::Event::time_s));
  note["text"] = "two\nlines";
  EXPECT_EQ(post("/api/files/annotate", note).status, 400);
}

TEST_F(FileRoutes, WhatIsBeingWrittenStaysAsItIs) {
  fs::rename(folder_ / "day/cut.h5", folder_ / "day/cut.h5.partial");
  const json partial{{"id", workspace_.id_of(folder_ / "day/cut.h5.partial")},
                     {"kind", "recording"},
                     {"name", "x"},
                     {"text", "x"}};
  for (const char* const path : {"/api/files/delete", "/api/files/rename", "/api/files/annotate"}) {
    const HttpResponse refused = post(path, partial);
    EXPECT_EQ(refused.status, 409) << path;
    EXPECT_THAT(refused.body, HasSubstr("is not closed"));
  }
}

}  // namespace
}  // namespace kerf::bench
