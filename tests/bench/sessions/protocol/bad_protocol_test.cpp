#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "protocol/protocol.h"

namespace kerf::bench {
namespace {

using test::protocol_from;
using test::protocol_text;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

struct BadProtocol {
  const char* name;
  std::string text;
  const char* message;
};
void PrintTo(const BadProtocol& bad, std::ostream* out) { *out << bad.name; }
class BadProtocols : public testing::TestWithParam<BadProtocol> {};

TEST_P(BadProtocols, AreRefusedWithTheLine) {
  EXPECT_THAT([] { (void)protocol_from(GetParam().text); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("p.protocol.toml:"), HasSubstr(GetParam().message))))
      << GetParam().text;
}

std::string of(const std::string& design, const std::string& more = "", const std::string& tables = "") {
  return protocol_text(fmt::format("design = \"{}\"\n{}", design, more), tables);
}

const BadProtocol bad_top[] = {
    {"Key", of("abx", "colour = 1"), ":4: unknown key 'colour' in a protocol"},
    {"NoDesign", protocol_text(""), "needs a 'design'"},
    {"Design", of("duo-trio"), "'design' is \"duo-trio\", expected one of \"preference\", \"abx\""},
    {"NoTrials", of("abx", "trials = 0"), "'trials' is 0, expected a number from 1 to 10000"},
    {"TooManyTrials", of("abx", "trials = 10001"), "'trials' is 10001"},
    {"HalfATrial", of("abx", "trials = 1.5"), "expected a whole number"},
    {"TrialsInText", of("abx", "trials = \"12\""), "must be a number"},
    {"Practice", of("abx", "practice = -1"), "'practice' is -1"},
    {"Interval", of("abx", "interval = 4"), "must be written { value = ..., unit = \"s\" }"},
    {"IntervalUnit", of("abx", "interval = { value = 4, unit = \"N\" }"), "expected s or a multiple"},
    {"IntervalRange", of("abx", "interval = { value = 0, unit = \"s\" }"), "from 0.1 to 600 s"},
    {"Ramp", of("2ifc", "signal = \"soft\"\nramp = { value = 4, unit = \"s\" }"), "less than the interval"},
    {"Presentation", of("abx", "presentation = \"mixed\""), "expected one of \"free\", \"sequence\""},
    {"Switching", of("abx", "switching = \"hard\""), "\"blend\", \"through-zero\""},
    {"Loudness", of("abx", "loudness = \"sone\""), "\"none\", \"peak\", \"rms\""},
    {"LoudnessWithoutMotion", of("abx", "loudness = \"rms\""), "needs a table [motion]"},
    {"LimitedShare", of("abx", "limited_share = 5"), "'limited_share' is 5, expected a number from 0 to 1"},
    {"Rate", of("abx", "rate = { value = 0, unit = \"Hz\" }"), "from 10 to 100000 Hz"},
    {"Break", of("abx", "break = { every = 0 }"), "'every' is 0"},
    {"BreakWithoutEvery", of("abx", "break = { at_least = { value = 3, unit = \"s\" } }"), "needs 'every'"},
    {"Feedback", of("preference", "practice = 1\nfeedback = true"), "no answer of a preference is right"},
    {"FeedbackOfNothing", of("abx", "feedback = true"), "expected 'practice' above 0"},
    {"Strategy", of("2ifc", "signal = \"soft\"\nstrategy = \"differencing\""),
     "for the designs \"abx\" and \"same-different\""},
    {"NoSignal", of("2ifc"), "needs 'signal'"},
    {"NoSignalNorOdd", of("3ifc"), "or odd_one_out = true"},
    {"UnknownSignal", of("2ifc", "signal = \"loud\""),
     "no sample \"loud\"; the samples are \"soft\", \"stiff\""},
    {"SignalInAbx", of("abx", "signal = \"soft\""), "for the designs \"2ifc\", \"3ifc\" and \"yes-no\""},
    {"SignalAndOdd", of("3ifc", "signal = \"soft\"\nodd_one_out = true"), "leave 'signal' out"},
    {"OddOfTwo", of("2ifc", "odd_one_out = true"), "for the design \"3ifc\""},
    {"Scale", of("abx", "", "[scale]\nvary = \"force\"\n"), "[scale] is for the designs of levels"},
};
const BadProtocol bad_samples[] = {
    {"None", "name = \"x\"\ndesign = \"abx\"\n", "needs its samples"},
    {"Table", "name = \"x\"\ndesign = \"abx\"\n[sample]\nname = \"y\"\n", "expected one [[sample]]"},
    {"Key", of("abx", "", "[[sample]]\nname = \"x\"\nfile = \"y\"\n"), "unknown key 'file' in a [[sample]]"},
    {"WithoutLaw", of("abx", "", "[[sample]]\nname = \"x\"\n"), "sample 'x' needs a 'law'"},
    {"NoSuchLaw", of("abx", "", "[[sample]]\nname = \"x\"\nlaw = \"no.toml\"\n"),
     ":13: there is no file no.toml"},
    {"Twice", of("abx", "", "[[sample]]\nname = \"soft\"\nlaw = \"soft.law.toml\"\n"),
     "there are two samples named 'soft'"},
    {"OtherAxis", of("abx", "", "[[sample]]\nname = \"x\"\nlaw = \"linear.law.toml\"\n"),
     "samples 'soft' and 'x' cannot be compared"},
    {"Spatial", of("abx", "", "[[sample]]\nname = \"x\"\nlaw = \"spatial.law.toml\"\n"),
     "cannot be compared"},
    {"TissueOfOne", of("abx", "", "[[tissue]]\nname = \"t\"\nsamples = [\"soft\"]\n"),
     "tissue 't' has one sample; expected two or more"},
    {"TissueOfUnknown", of("abx", "", "[[tissue]]\nname = \"t\"\nsamples = [\"soft\", \"x\"]\n"),
     ":13: there is no sample \"x\""},
    {"TissueOfTwins", of("abx", "", "[[tissue]]\nname = \"t\"\nsamples = [\"soft\", \"soft\"]\n"),
     "has sample 'soft' twice"},
    {"TissueWithoutSamples", of("abx", "", "[[tissue]]\nname = \"t\"\n"), "needs 'samples'"},
    {"TissuesOfOneName",
     of("abx", "",
        "[[tissue]]\nname = \"t\"\nsamples = [\"soft\", \"stiff\"]\n[[tissue]]\nname = \"t\"\nsamples = "
        "[\"soft\", \"stiff\"]\n"),
     ":15: there are two tissues named 't'"},
    {"Unused",
     of("abx", "",
        "[[sample]]\nname = \"x\"\nlaw = \"third.law.toml\"\n[[tissue]]\nname = \"t\"\nsamples = [\"soft\", "
        "\"stiff\"]\n"),
     "sample 'x' is in no [[tissue]]"},
    {"TissueWithoutSignal",
     of("2ifc", "signal = \"stiff\"",
        "[[sample]]\nname = \"x\"\nlaw = \"third.law.toml\"\n[[tissue]]\nname = \"t\"\nsamples = [\"soft\", "
        "\"x\"]\n[[tissue]]\nname = \"u\"\nsamples = [\"soft\", \"stiff\"]\n"),
     "tissue 't' is without the signal 'stiff'"},
    {"TooManyPairs", of("abx", "trials = 3000", test::two_tissues), "12000 trials a subject"},
};
const BadProtocol bad_motions[] = {
    {"Nothing", of("abx", "", "[motion]\n"), "'from' is missing"},
    {"Unit", of("abx", "", "[motion]\nfrom = { value = 1, unit = \"m\" }\n"), "expected rad or a multiple"},
    {"Still",
     of("abx", "", "[motion]\nfrom = { value = 1, unit = \"rad\" }\nto = { value = 1, unit = \"rad\" }\n"),
     "nothing moves"},
    {"SceneWithStrokes", of("abx", "", "[motion]\nscene = \"s\"\nfrom = { value = 1, unit = \"m\" }\n"),
     "unknown key 'from' in a [motion] of a scene"},
    {"SpatialStrokes",
     "name = \"x\"\ndesign = \"abx\"\n[[sample]]\nname = \"a\"\nlaw = \"spatial.law.toml\"\n[[sample]]\nname "
     "= \"b\"\nlaw = \"spatial.law.toml\"\n[motion]\nfrom = { value = 1, unit = \"rad\" }\n",
     "its [motion] is a 'scene'"},
};
const auto name_of_bad = [](const auto& tested) { return std::string(tested.param.name); };
INSTANTIATE_TEST_SUITE_P(AtTheTop, BadProtocols, testing::ValuesIn(bad_top), name_of_bad);
INSTANTIATE_TEST_SUITE_P(InSamples, BadProtocols, testing::ValuesIn(bad_samples), name_of_bad);
INSTANTIATE_TEST_SUITE_P(InMotion, BadProtocols, testing::ValuesIn(bad_motions), name_of_bad);

}  // namespace
}  // namespace kerf::bench
