#include "results/crate.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

class Crate : public testing::Test {
 protected:
  json crate() {
    test::write_text(folder_ / "study.toml", "version = 1\n");
    std::filesystem::create_directory(folder_ / "inputs");
    test::write_text(folder_ / "inputs/a b.txt", "1 2 3\n");
    results_.name = "liver";
    return study_crate(results_, folder_.path());
  }
  static json entity(const json& crate, const std::string& id) {
    for (const json& one : crate.at("@graph"))
      if (one.at("@id") == id) return one;
    return nullptr;
  }
  test::TemporaryFolder folder_;
  StudyResults results_;
};

// The rules of RO-Crate 1.1 that a validator calls REQUIRED, and those of Process Run Crate 0.5.
TEST_F(Crate, KeepsTheRulesOfItsSpecification) {
  const json crate = this->crate();
  EXPECT_EQ(crate.at("@context"), "https://w3id.org/ro/crate/1.1/context");
  const json descriptor = entity(crate, "ro-crate-metadata.json");
  EXPECT_EQ(descriptor.at("@type"), "CreativeWork");
  EXPECT_EQ(descriptor.at("about").at("@id"), "./");
  EXPECT_EQ(descriptor.at("conformsTo").at("@id"), "https://w3id.org/ro/crate/1.1");
  const json root = entity(crate, "./");
  for (const char* key : {"name", "description", "datePublished", "license", "hasPart"})
    EXPECT_TRUE(root.contains(key)) << key;
  std::set<std::string> ids;
  for (const json& one : crate.at("@graph")) {
    EXPECT_TRUE(one.contains("@type"));
    EXPECT_TRUE(ids.insert(one.at("@id").get<std::string>()).second) << one.at("@id");
  }
  // Flat: whatever is referred to is an entity, and nothing is nested.
  for (const json& one : crate.at("@graph")) {
    for (const auto& [key, value] : one.items()) {
      const json references = value.is_array() ? json(value) : json::array({value});
      for (const json& reference : references) {
        if (!reference.is_object()) continue;
        ASSERT_EQ(reference.size(), 1U) << key;
        const auto id = reference.at("@id").get<std::string>();
        if (id.starts_with("http") && key != "license") continue;
        EXPECT_TRUE(ids.contains(id)) << key << " " << id;
      }
    }
  }
  const json action = entity(crate, "#run");
  EXPECT_EQ(action.at("@type"), "CreateAction");
  EXPECT_EQ(action.at("instrument").at("@id"), "#kerf");
}

// The digest is that of sha256sum.
TEST_F(Crate, NamesEveryFileWithItsDigest) {
  const json file = entity(crate(), "inputs/a%20b.txt");
  ASSERT_FALSE(file.is_null());
  EXPECT_EQ(file.at("sha256"), "1def07dbe06eeb097aafec8a40329937cd20c93a83634b8221ea2b41a894310c");
  EXPECT_EQ(file.at("contentSize"), "6");
}

TEST_F(Crate, NamesNobodyWhoWasNotGiven) {
  EXPECT_FALSE(entity(crate(), "./").contains("author"));
  EXPECT_EQ(entity(crate(), "./").at("license").at("@id"), "#no-licence");
  results_.plan.people = {"Ada"};
  results_.plan.licence = "https://creativecommons.org/licenses/by/4.0/";
  EXPECT_EQ(entity(crate(), "#person-1").at("name"), "Ada");
  EXPECT_EQ(entity(crate(), "./").at("license").at("@id"), results_.plan.licence);
}

}  // namespace
}  // namespace kerf::bench
