#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/models/law.h>

#include "libkerf/opened.h"
#include "support/example_laws.h"

namespace kerf {
namespace {

using testing::HasSubstr;
using testing::StrEq;

/// Why a text is refused.
std::string refusal(const std::string& text, std::size_t room = 1000) {
  std::string error(room, 'x');
  kerf_law* law = reinterpret_cast<kerf_law*>(&error);
  EXPECT_EQ(kerf_law_parse(text.data(), text.size(), "wall.law.toml", &law, error.data(), error.size()),
            KERF_BAD_INPUT);
  EXPECT_EQ(law, nullptr);
  return error.c_str();
}

std::string replaced(const std::string& from, const std::string& to) {
  std::string text(test::wall);
  return text.replace(text.find(from), from.size(), to);
}

TEST(KerfLawOpen, TellsWhatTheFileSays) {
  const test::OpenLaw law = test::parsed(test::wall);
  EXPECT_THAT(kerf_law_model(law.get()), StrEq("friction"));
  EXPECT_THAT(kerf_law_equation(law.get()), StrEq(std::string(models::law_info("friction").equation)));
  EXPECT_EQ(kerf_law_is_spatial(law.get()), 0);
  const kerf_contact contact = kerf_law_contact(law.get());
  EXPECT_DOUBLE_EQ(contact.position, 0.01);
  EXPECT_EQ(contact.direction, 1.0);

  kerf_axis axis{};
  ASSERT_EQ(kerf_law_axis_count(law.get()), 1U);
  ASSERT_EQ(kerf_law_axis(law.get(), 0, &axis), KERF_OK);
  EXPECT_THAT(axis.name, StrEq("position"));
  EXPECT_THAT(axis.position_unit, StrEq("m"));
  EXPECT_THAT(axis.force_unit, StrEq("N"));
  EXPECT_EQ(kerf_law_axis(law.get(), 1, &axis), KERF_BAD_INPUT);

  kerf_parameter parameter{};
  ASSERT_EQ(kerf_law_parameter_count(law.get()), 5U);
  ASSERT_EQ(kerf_law_parameter(law.get(), 1, &parameter), KERF_OK);
  EXPECT_THAT(parameter.name, StrEq("stiffness"));
  EXPECT_THAT(parameter.unit, StrEq("N/m"));
  EXPECT_EQ(parameter.value, 100.0);
  EXPECT_LT(parameter.lower, parameter.upper);
  EXPECT_TRUE(std::isnan(parameter.std_error)) << "the others have none";
  EXPECT_EQ(kerf_law_parameter(law.get(), 5, &parameter), KERF_BAD_INPUT);
}

TEST(KerfLawOpen, HashesTheTextThatItRead) {
  const test::OpenLaw law = test::opened(test::example_file("friction"));
  std::ifstream file(test::example_file("friction"));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(kerf_law_text(law.get()), text);
  // By sha256sum.
  EXPECT_STREQ(kerf_law_sha256(test::parsed(test::wall).get()),
               "87bcfae83a3d99757b4484d63f75520a2d27c6d938fab069260a0d1e36916bc9");
  EXPECT_STRNE(kerf_law_sha256(law.get()), kerf_law_sha256(test::parsed(text + "\n").get()));
  EXPECT_STREQ(kerf_law_sha256(law.get()), kerf_law_sha256(test::parsed(text).get()));
}

TEST(KerfLawOpen, RefusesInOneLineWithFileAndLine) {
  EXPECT_THAT(refusal(replaced("friction", "rubber")),
              testing::AllOf(testing::StartsWith("wall.law.toml:1: unknown law 'rubber'; the laws are "),
                             testing::EndsWith("; one of a plug-in is known after kerf_plugin_load()")));
  EXPECT_THAT(
      refusal(replaced("0.1, unit", "-3e9, unit")),
      HasSubstr("wall.law.toml:6: parameter 'stiffness' is -3000000000000 in SI, expected a number from "));
  EXPECT_THAT(refusal("model = "), HasSubstr("wall.law.toml:1: not TOML"));
  EXPECT_THAT(refusal(""), HasSubstr("no 'model'"));
  kerf_law* law = nullptr;
  std::array<char, 300> error{};
  EXPECT_EQ(kerf_law_open("/nowhere/x.law.toml", &law, error.data(), error.size()), KERF_BAD_INPUT);
  EXPECT_STREQ(error.data(), "/nowhere/x.law.toml: no such file");
  EXPECT_EQ(kerf_law_open(nullptr, &law, nullptr, 0), KERF_BAD_INPUT);
}

TEST(KerfLawOpen, SaysWhenALaterVersionWroteTheFile) {
  const std::string with_news = replaced("[contact]", "healing = 3\n[contact]");
  EXPECT_THAT(refusal("# kerf 9.1.0 (0123456789ab)\n" + with_news),
              testing::AllOf(
                  HasSubstr("unknown key 'healing'"),
                  HasSubstr("(kerf 9.1.0 wrote the file, and this is " + std::string(kerf_version()) + ")")));
  EXPECT_THAT(refusal("# kerf 0.0.9 (0123456789ab)\n" + with_news),
              testing::Not(HasSubstr("wrote the file")));
  EXPECT_THAT(refusal("# kerf some day\n" + with_news), testing::Not(HasSubstr("wrote the file")));
}

TEST(KerfLawOpen, CutsAMessageThatDoesNotFitBetweenCharacters) {
  const std::string unit = replaced("\"N·s/m\"", "\"N·\"");
  const std::string whole = refusal(unit);
  ASSERT_NE(whole.find("·"), std::string::npos);
  for (std::size_t room = 1; room <= whole.size() + 1; ++room) {
    const std::string cut = refusal(unit, room);
    EXPECT_LT(cut.size(), room);
    EXPECT_TRUE(whole.starts_with(cut));
    EXPECT_NE(cut.empty() ? '\0' : cut.back(), "·"[0]) << "half a character";
  }
}

models::OptionValue value_of(const kerf_option& option) {
  if (option.kind == KERF_OPTION_FLAG) return option.number != 0.0;
  if (option.kind == KERF_OPTION_TEXT) return std::string(option.text);
  return option.number;
}

/// All options of the model, set to what was given.
void expect_options(const kerf_law* law, const std::vector<models::OptionInfo>& of_model,
                    const models::Options& given) {
  ASSERT_EQ(kerf_law_option_count(law), of_model.size());
  kerf_option_info option{};
  for (std::size_t i = 0; i < of_model.size(); ++i) {
    ASSERT_EQ(kerf_law_option(law, i, &option), KERF_OK);
    EXPECT_THAT(option.value.name, StrEq(of_model[i].name));
    EXPECT_THAT(option.meaning, StrEq(of_model[i].meaning));
    EXPECT_EQ(value_of(option.standard), of_model[i].standard);
    const auto found = given.find(of_model[i].name);
    EXPECT_EQ(value_of(option.value), found == given.end() ? of_model[i].standard : found->second);
  }
  EXPECT_EQ(kerf_law_option(law, of_model.size(), &option), KERF_BAD_INPUT);
}

TEST(KerfLawMake, GivesEveryLawOfTheRegistryByNameAsItsFileDoes) {
  std::set<std::string> names;
  for (std::size_t model = 0; model < kerf_model_count(); ++model) {
    const std::string name = kerf_model_name(model);
    SCOPED_TRACE(name);
    names.insert(name);
    const models::Law like = test::example(name);
    std::vector<kerf_value> values;
    const auto infos = like.parameters();
    // The last one first: the order does not matter.
    for (std::size_t i = infos.size(); i-- > 0;) values.push_back({infos[i].name.c_str(), like.values()[i]});
    std::vector<kerf_option> options;
    for (const auto& [option, value] : like.options()) {
      kerf_option one{option.c_str(), KERF_OPTION_NUMBER, 0.0, nullptr};
      if (const bool* flag = std::get_if<bool>(&value)) {
        one.kind = KERF_OPTION_FLAG;
        one.number = *flag ? 1.0 : 0.0;
      } else if (const double* number = std::get_if<double>(&value)) {
        one.number = *number;
      } else {
        one.kind = KERF_OPTION_TEXT;
        one.text = std::get<std::string>(value).c_str();
      }
      options.push_back(one);
    }
    kerf_law* made = nullptr;
    std::array<char, 500> error{};
    ASSERT_EQ(kerf_law_make(name.c_str(), values.data(), values.size(), options.data(), options.size(), &made,
                            error.data(), error.size()),
              KERF_OK)
        << error.data();
    const test::OpenLaw law(made, &kerf_law_close);
    ASSERT_EQ(kerf_law_parameter_count(made), infos.size());
    // Its text is the law file that says the same.
    const test::OpenLaw again = test::parsed(kerf_law_text(made));
    for (std::size_t i = 0; i < infos.size(); ++i) {
      kerf_parameter one{};
      kerf_parameter read{};
      ASSERT_EQ(kerf_law_parameter(made, i, &one), KERF_OK);
      ASSERT_EQ(kerf_law_parameter(again.get(), i, &read), KERF_OK);
      EXPECT_EQ(one.value, like.values()[i]);
      EXPECT_EQ(read.value, one.value);
      EXPECT_STREQ(read.unit, one.unit);
    }
    EXPECT_STREQ(kerf_law_sha256(again.get()), kerf_law_sha256(made));
    expect_options(made, models::Law::options(name), like.options());
  }
  EXPECT_EQ(names.size(), models::registry().size());
  EXPECT_EQ(kerf_model_name(kerf_model_count()), nullptr);
}

TEST(KerfLawMake, RefusesWhatIsMissingUnknownOrTwice) {
  const auto why = [](std::vector<kerf_value> values, std::vector<kerf_option> options = {}) {
    kerf_law* law = nullptr;
    std::array<char, 500> error{};
    EXPECT_EQ(kerf_law_make("precontact", values.data(), values.size(), options.data(), options.size(), &law,
                            error.data(), error.size()),
              KERF_BAD_INPUT);
    return std::string(error.data());
  };
  EXPECT_EQ(why({{"width", 0.01}}),
            "law 'precontact': 1 of 2 parameters are missing; the law takes stiffness, width");
  EXPECT_THAT(why({{"width", 0.01}, {"stiffness", 1.0}, {"depth", 1.0}}),
              HasSubstr("unknown parameter 'depth'"));
  EXPECT_THAT(why({{"width", 0.01}, {"width", 0.02}}), HasSubstr("'width' is given twice"));
  EXPECT_THAT(why({{"width", 0.01}, {"stiffness", -1.0}}),
              HasSubstr("parameter 'stiffness' is -1, expected"));
  EXPECT_THAT(why({{"width", 0.01}, {"stiffness", std::nan("")}}), HasSubstr("parameter 'stiffness' is nan"));
  EXPECT_THAT(why({{"width", 0.01}, {"stiffness", 1.0}}, {{"colour", KERF_OPTION_TEXT, 0.0, "red"}}),
              HasSubstr("colour"));
  EXPECT_THAT(why({}, {{"colour", KERF_OPTION_TEXT, 0.0, nullptr}}), HasSubstr("expected KERF_OPTION_FLAG"));
}

TEST(KerfVersion, IsThatOfTheHeader) {
  EXPECT_EQ(kerf_abi_version(), std::uint32_t{KERF_ABI_VERSION});
  EXPECT_THAT(kerf_software(), testing::StartsWith("kerf " + std::string(kerf_version())));
  EXPECT_STREQ(kerf_status_text(KERF_BAD_INPUT), "bad input");
  EXPECT_STREQ(kerf_status_text(77), "an unknown status");
  EXPECT_STREQ(kerf_flag_text(KERF_LAW_FAULT), "the law gave no finite force: zero force");
  EXPECT_EQ(kerf_flag_text(1 << 0), nullptr) << "a loop's, not the library's";
  EXPECT_EQ(kerf_flag_text(0), nullptr);
}

}  // namespace
}  // namespace kerf
