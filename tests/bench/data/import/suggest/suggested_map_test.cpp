#include "import/suggest/suggested_map.h"

#include <cmath>
#include <functional>
#include <string>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "formats/file_text.h"
#include "import/suggest/time_column.h"
#include "support/measured_data.h"

namespace kerf::bench {
namespace {

std::string suggested_for(const std::string& text) { return suggest_map(find_layout(text, "t.txt"), text); }

/// Lines of a tool that goes to and fro, and of its force, behind or before other columns.
std::string lines_of(int count, const std::function<std::string(int row, const std::string& others)>& line) {
  std::string text;
  for (int row = 0; row < count; ++row)
    text += line(row, fmt::format("{:.3f}\t{:.3f}", std::sin(0.01 * row), std::cos(0.02 * row))) + '\n';
  return text;
}

TEST(SuggestedMap, GoesByTheUnitsThatAreKnownThenByNamesAndElseByPlace) {
  const TextLayout punched{.separator = ',',
                           .columns = {{"t [ms]", "t", "ms"},
                                       {"Angle", "Angle", ""},
                                       {"Load, total [gf]", "Load, total", "gf"},
                                       {"way [mm]", "way", "mm"}}};
  EXPECT_EQ(suggest_map(punched, ""), "--map 'time=1[ms],position=4[mm],force=3[gf]'");
  TextLayout layout{.columns = {{}, {}, {}}};
  EXPECT_EQ(suggest_map(layout, ""), "--map 'time=1[s],position=2[mm],force=3[N]'");
  layout.columns.pop_back();
  EXPECT_EQ(suggest_map(layout, ""), "--map 'position=1[mm],force=2[N]' --rate 100");
  layout.columns = {{"site", "site", ""}, {"F_N", "F_N", "N"}, {"depth_mm", "depth_mm", "mm"}};
  EXPECT_EQ(suggest_map(layout, ""), "--map 'position=3[mm],force=2[N]' --rate 100");
  layout.columns = {{"Load", "Load", ""}, {"Angle", "Angle", ""}, {"Time", "Time", ""}};
  EXPECT_EQ(suggest_map(layout, ""), "--map 'time=3[s],position=2[deg],force=1[N]'");
}

TEST(SuggestedMap, TakesTheUnnamedColumnThatCountsOnForTheTime) {
  const auto last = [](double step) {
    return lines_of(900, [step](int row, const std::string& others) {
      return fmt::format("{}\t{}", others, 17000.0 + step * row);
    });
  };
  EXPECT_EQ(suggested_for(last(0.001)), "--map 'time=3[s],position=1[mm],force=2[N]'");
  EXPECT_EQ(suggested_for(last(2.5)), "--map 'time=3[ms],position=1[mm],force=2[N]'");
  EXPECT_EQ(suggested_for(last(1000)), "--map 'time=3[us],position=1[mm],force=2[N]'");
}

TEST(SuggestedMap, TakesAHeadersWordBeforeAColumnThatCountsOn) {
  const auto of = [](const std::string& header) {
    return suggested_for(header + '\n' + lines_of(900, [](int row, const std::string& others) {
                           return fmt::format("{}\t{}", others, row);
                         }));
  };
  EXPECT_EQ(of("a\tb\tc"), "--map 'time=3[ms],position=1[mm],force=2[N]'");
  EXPECT_EQ(of("Time\tb\tc"), "--map 'time=1[s],position=2[mm],force=3[N]'");
  EXPECT_EQ(of("a\tb [s]\tc"), "--map 'time=2[s],position=1[mm],force=3[N]'");
  EXPECT_EQ(of("a\tb\tc [mm]"), "--map 'position=3[mm],force=1[N]' --rate 100") << "a way, whatever it does";
  EXPECT_EQ(of("F\tb\tPosition"), "--map 'time=2[s],position=3[mm],force=1[N]'") << "likewise";
}

TEST(SuggestedMap, TakesNoColumnForTheTimeThatOnlySometimesGrows) {
  const auto with = [](const std::function<double(int)>& third) {
    return suggested_for(lines_of(900, [&](int row, const std::string& others) {
      return fmt::format("{}\t{:.6f}", others, third(row));
    }));
  };
  const std::string by_place = "--map 'time=1[s],position=2[mm],force=3[N]'";
  EXPECT_EQ(with([](int row) { return row < 450 ? 0.01 * row : 9.0 - 0.01 * row; }), by_place)
      << "to and fro";
  EXPECT_EQ(with([](int row) { return std::exp(0.05 * row); }), by_place) << "ever faster";
  EXPECT_EQ(with([](int row) { return 0.01 * std::floor(row / 4.0); }), by_place) << "in stairs";
  const std::string by_time = "--map 'time=3[s],position=1[mm],force=2[N]'";
  EXPECT_EQ(with([](int row) { return 0.01 * row + (row > 400 ? 5.0 : 0.0); }), by_time) << "a gap";
  EXPECT_EQ(with([](int row) { return 0.01 * (row % 300 == 7 ? row - 1 : row); }), by_time) << "a line twice";
}

TEST(SuggestedMap, TakesAClockBeforeACountOfLines) {
  EXPECT_EQ(suggested_for(lines_of(300,
                                   [](int row, const std::string& others) {
                                     return fmt::format("{}\t{:.4f}\t{}", row + 1, 0.0025 * row, others);
                                   })),
            "--map 'time=2[s],position=1[mm],force=3[N]'");
}

TEST(SuggestedMap, FindsTheTimeOfMeasuredDataWithoutAHeader) {
  const std::string punch = "meniscus/9_meniscus_slow_1824.txt";
  KERF_NEEDS_DATA(punch);
  const FileText text(test::measured_file(punch), {.max_bytes = std::size_t{64} << 20U, .sheet = {}});
  EXPECT_EQ(suggest_map(find_layout(text.text(), text.name()), text.text()),
            "--map 'time=5[ms],position=1[mm],force=2[N]'");
}

}  // namespace
}  // namespace kerf::bench
