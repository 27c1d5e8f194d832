// Laws of every kind through each host that carries them as C: one with a state, one that remembers long, one
// with a table.

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/export/example_export.h"
#include "export_law.h"
#include "exported_law.h"
#include "support/program.h"
#include "verify/verify.h"

namespace kerf::bench {
namespace {

struct Carried {
  const char* host;
  const char* law;
};
void PrintTo(const Carried& carried, std::ostream* out) { *out << carried.law << " in " << carried.host; }

class CarriedLaw : public testing::TestWithParam<Carried> {};

TEST_P(CarriedLaw, IsTheSameInTheHostToTheBit) {
  if (std::string_view(GetParam().host) == "octave" &&
      test::run({"/usr/bin/env", "mkoctfile", "--version"}).exit_status != 0)
    GTEST_SKIP() << "no mkoctfile";
  const test::TemporaryFolder folder;
  const Host& host = host_named(GetParam().host);
  const ExportedLaw law = read_for(
      host, std::filesystem::path(KERF_SOURCE_DIR "/examples") / (std::string(GetParam().law) + ".law.toml"),
      "");
  write_for(host, law, folder.path());
  const Verified verified = verify(host, law, folder.path(), 5'000);
  EXPECT_EQ(verified.samples, 5'000U);
  EXPECT_EQ(verified.largest_ulp, 0.0) << "at " << verified.at;
  EXPECT_EQ(verified.faults, 0U);
  EXPECT_GT(verified.most_force, 0.01);
}

INSTANTIATE_TEST_SUITE_P(In, CarriedLaw,
                         testing::Values(Carried{"fmu", "kelvin"}, Carried{"fmu", "recording"},
                                         Carried{"octave", "maxwell"}, Carried{"python", "fuzzy_kelvin"}),
                         [](const testing::TestParamInfo<Carried>& info) {
                           return std::string(info.param.law) + "_in_" + info.param.host;
                         });

}  // namespace
}  // namespace kerf::bench
