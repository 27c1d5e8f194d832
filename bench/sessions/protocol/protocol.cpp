#include "protocol/protocol.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "files/named_file.h"
#include "laws/plugin_laws.h"
#include "protocol/protocol_parts.h"
#include "replay/table.h"
#include "scene/read_motion.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr double longest_session_part_s = 3600.0;

Design read_design(const Place& place, const toml::table& root) {
  if (!root.contains("design")) {
    place.refuse(root,
                 "a protocol needs a 'design': \"preference\", \"abx\", \"2ifc\", \"3ifc\", \"constant\", "
                 "\"staircase\", \"quest\", \"same-different\", \"yes-no\", \"magnitude\" or \"rating\"");
  }
  return read_choice(place, root, "design", Design::preference,
                     {{"preference", Design::preference},
                      {"abx", Design::abx},
                      {"2ifc", Design::two_interval},
                      {"3ifc", Design::three_interval},
                      {"constant", Design::constant},
                      {"staircase", Design::staircase},
                      {"quest", Design::quest_plus},
                      {"same-different", Design::same_different},
                      {"yes-no", Design::yes_no},
                      {"magnitude", Design::magnitude},
                      {"rating", Design::rating}});
}

/// What a subject is asked; designs whose question is always the same have it without being told.
std::string read_question(const Place& place, const toml::table& root, const Protocol& protocol) {
  std::string question = read_plain_text(place, root, "question");
  if (question.find_first_not_of(" \t\r\n") != std::string::npos) return question;
  const SubjectTexts& texts = *protocol.texts;
  if (protocol.design == Design::abx) return texts("question_abx");
  if (protocol.odd_one_out) return texts("question_odd");
  if (protocol.design == Design::same_different) return texts("question_same_different");
  place.refuse(node_or_table(root, "question"),
               "a protocol needs a 'question', such as question = \"Which felt stiffer?\"");
}

double standard_trials(Design design) {
  if (design == Design::staircase) return 100.0;
  return design == Design::quest_plus ? 60.0 : 12.0;
}

/// Words from the least sure to the surest; none: it is not asked.
void read_confidence(const Place& place, const toml::table& root, Protocol& protocol) {
  constexpr std::size_t most = 4;
  if (protocol.design == Design::yes_no) {
    const SubjectTexts& texts = *protocol.texts;
    protocol.confidence = {texts("confidence_guessing"), texts("confidence_fairly_sure"),
                           texts("confidence_sure")};
  }
  const toml::node* node = root.get("confidence");
  if (node == nullptr) return;
  if (protocol.design != Design::yes_no)
    place.refuse(*node, "'confidence' is for the design \"yes-no\", and this is \"{}\"",
                 name_of(protocol.design));
  const toml::array* words = node->as_array();
  if (words == nullptr || words->size() == 1 || words->size() > most ||
      (!words->empty() && !words->is_homogeneous<std::string>())) {
    place.refuse(*node,
                 "'confidence' must be an array of 2 to {} words, from the least sure to the surest, or "
                 "empty: not asked",
                 most);
  }
  protocol.confidence.clear();
  for (const toml::node& each : *words) {
    protocol.confidence.push_back(**each.as_string());
    const std::string& last = protocol.confidence.back();
    const bool is_plain = !last.empty() && last.size() <= 40 && std::ranges::none_of(last, [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
    });
    if (!is_plain)
      place.refuse(each, "'{}' is no word for how sure somebody is; expected 1 to 40 plain characters", last);
    if (std::ranges::count(protocol.confidence, last) > 1) place.refuse(each, "'{}' is there twice", last);
  }
}

void read_trials(const Place& place, const toml::table& root, Protocol& protocol) {
  const auto count = [&](std::string_view key, double standard, double lower) {
    return read_count(place, root, {.key = key, .standard = standard, .lower = lower, .upper = max_trials});
  };
  protocol.trials = count("trials", standard_trials(protocol.design), 1.0);
  protocol.practice = count("practice", 0.0, 0.0);
  protocol.feedback = place.flag(root, "feedback", false);
  if (const toml::node* node = root.get("strategy")) {
    if (protocol.design != Design::abx && protocol.design != Design::same_different)
      place.refuse(*node, "'strategy' is for the designs \"abx\" and \"same-different\", and this is \"{}\"",
                   name_of(protocol.design));
    protocol.differencing =
        read_choice(place, root, "strategy", false, {{"independent", false}, {"differencing", true}});
  }
  read_confidence(place, root, protocol);
  if (!root.contains("break")) return;
  const toml::table& pause = place.table(root, "break");
  place.allow_only(pause, {"every", "at_least"}, "[break]");
  if (!pause.contains("every")) place.refuse(pause, "[break] needs 'every', a number of trials");
  protocol.break_every = read_count(place, pause, {.key = "every", .lower = 1.0, .upper = max_trials});
  protocol.break_s = read_seconds(place, pause, "at_least", protocol.break_s, 0.0, longest_session_part_s);
}

void read_presentation(const Place& place, const toml::table& root, Protocol& protocol) {
  const bool is_free = protocol.design == Design::preference || protocol.design == Design::abx;
  protocol.presentation =
      read_choice(place, root, "presentation", is_free ? Presentation::free : Presentation::sequence,
                  {{"free", Presentation::free}, {"sequence", Presentation::sequence}});
  if (asks_numbers(protocol.design) && protocol.presentation == Presentation::free)
    place.refuse(*root.get("presentation"),
                 "the design \"{}\" plays each sample by itself; leave 'presentation' out",
                 name_of(protocol.design));
  protocol.interval_s = read_seconds(place, root, "interval", protocol.interval_s, 0.1, 600.0);
  protocol.gap_s = read_seconds(place, root, "gap", protocol.gap_s, 0.0, 60.0);
  protocol.switching = read_choice(
      place, root, "switching",
      protocol.design == Design::abx || protocol.design == Design::same_different ? SwitchKind::through_zero
                                                                                  : SwitchKind::blend,
      {{"blend", SwitchKind::blend}, {"through-zero", SwitchKind::through_zero}});
  protocol.ramp_s = read_seconds(place, root, "ramp", protocol.ramp_s, 0.0, 10.0);
  const auto slots = static_cast<double>(slots_of(protocol));
  const bool in_sequence = protocol.presentation == Presentation::sequence;
  const double all_s = in_sequence ? slots * protocol.interval_s + (slots - 1.0) * protocol.gap_s : 0.0;
  protocol.longest_s =
      read_seconds(place, root, "longest", std::max(protocol.longest_s, all_s), 1.0, longest_session_part_s);
  if (protocol.longest_s < all_s) {
    place.refuse(*root.get("longest"), "'longest' is {:g} s, and the {:g} intervals of a trial last {:g} s",
                 protocol.longest_s, slots, all_s);
  }
  if (in_sequence && protocol.ramp_s >= protocol.interval_s) {
    place.refuse(node_or_table(root, "ramp"),
                 "the ramp lasts {:g} s, expected less than the interval of {:g} s", protocol.ramp_s,
                 protocol.interval_s);
  }
}

/// There is a target whose way is the motion of the trials.
bool leads_along(const Protocol& protocol) {
  return protocol.guide && protocol.guide->has_target() && protocol.guide->leads(false);
}

void read_rendering(const Place& place, const toml::table& root, Protocol& protocol) {
  protocol.device_uri = read_plain_text(place, root, "device");
  protocol.rate_hz = read_number(
      place, root, {.key = "rate", .unit = "Hz", .standard = protocol.rate_hz, .lower = 10.0, .upper = 1e5});
  protocol.loudness = read_choice(place, root, "loudness", Loudness::as_they_are,
                                  {{"none", Loudness::as_they_are},
                                   {"peak", Loudness::peak},
                                   {"rms", Loudness::rms},
                                   {"felt-peak", Loudness::felt_peak},
                                   {"felt-rms", Loudness::felt_rms}});
  protocol.limited_share = read_plain_number(
      place, root, {.key = "limited_share", .standard = protocol.limited_share, .lower = 0.0, .upper = 1.0});
  if (protocol.loudness == Loudness::as_they_are) return;
  if (has_levels(protocol.design) || root.contains("scale")) {
    place.refuse(*root.get("loudness"),
                 "a design of levels asks how strong samples are; leave 'loudness' out");
  }
  const bool in_open_loop = protocol.loudness == Loudness::peak || protocol.loudness == Loudness::rms;
  if (in_open_loop && !root.contains("motion") && !leads_along(protocol))
    place.refuse(*root.get("loudness"),
                 "'loudness' needs a table [motion], or a [guide] with a target, along which forces are "
                 "compared");
}

/// The one unit in which all laws measure the axis of the strokes.
std::string unit_of_strokes(const Place& place, const toml::table& table, const Protocol& protocol) {
  const SessionSample& first = protocol.samples.front();
  for (const SessionSample& sample : protocol.samples) {
    if (sample.law.law.is_spatial()) {
      place.refuse(table, "the law of sample '{}' acts on several axes; its [motion] is a 'scene'",
                   sample.name);
    }
    if (sample.law.position_unit != first.law.position_unit) {
      place.refuse(table, "sample '{}' moves in {} and sample '{}' in {}; one [motion] cannot serve both",
                   first.name, first.law.position_unit, sample.name, sample.law.position_unit);
    }
  }
  return first.law.position_unit;
}

void read_session_motion(const Place& place, const toml::table& root, Protocol& protocol) {
  if (!root.contains("motion")) {
    if (leads_along(protocol)) protocol.motion = motion_of(*protocol.guide);
    return;
  }
  const toml::table& table = place.table(root, "motion");
  MotionSource motion;
  motion.seconds = read_seconds(place, table, "seconds", 4.0, 0.01, longest_session_part_s);
  if (table.contains("scene")) {
    place.allow_only(table, {"scene", "seconds"}, "a [motion] of a scene");
    motion.scene = read_plain_text(place, table, "scene");
    if (motion.scene.empty()) place.refuse(*table.get("scene"), "'scene' is empty, expected a file");
  } else {
    place.allow_only(table, {"from", "to", "stroke", "pause", "seconds"}, "a [motion] of strokes");
    const std::string unit = unit_of_strokes(place, table, protocol);
    const StrokesToAndFro strokes = read_strokes(place, table,
                                                 {.unit = unit,
                                                  .standard = {.stroke_s = 0.8, .pause_s = 0.25},
                                                  .shortest_s = 0.01,
                                                  .longest_s = 600.0,
                                                  .longest_pause_s = 600.0});
    if (strokes.from == strokes.to) place.refuse(*table.get("to"), "'to' is where 'from' is: nothing moves");
    motion.axes = {{.axis = 0, .script = strokes}};
  }
  protocol.motion = motion;
}

/// What the subject reads: in a language of the program, or of a file.
std::shared_ptr<const SubjectTexts> read_texts(const Place& place, const toml::table& root,
                                               const std::function<std::string(const std::string&)>& text_of,
                                               std::shared_ptr<const SubjectTexts> kept) {
  const std::string language = read_choice(place, root, "language", std::string("en"),
                                           {{"en", std::string("en")}, {"de", std::string("de")}});
  const std::string file = read_plain_text(place, root, "texts");
  if (root.contains("texts") && file.empty())
    place.refuse(*root.get("texts"), "'texts' is empty, expected a file of the texts in another language");
  if (root.contains("texts") && root.contains("language"))
    place.refuse(*root.get("language"),
                 "'texts' brings a language of its own, which its file names; leave 'language' out");
  if (kept) return kept;
  if (file.empty()) return shipped_texts(language);
  std::string toml;
  try {
    toml = text_of(file);
  } catch (const std::invalid_argument& error) {
    place.refuse(*root.get("texts"), "'texts': {}", error.what());
  }
  return parse_texts(toml, file);
}

/// What only the whole of a protocol tells.
void require_sense(const Place& place, const toml::table& root, const Protocol& protocol) {
  if (protocol.feedback) {
    const toml::node& node = *root.get("feedback");
    if (asks_numbers(protocol.design)) place.refuse(node, "no number is right; leave 'feedback' out");
    if (protocol.design == Design::preference)
      place.refuse(node, "no answer of a preference is right; leave 'feedback' out");
    if (protocol.design == Design::constant && protocol.scale.two_sided())
      place.refuse(node, "with levels on both sides no answer is right; leave 'feedback' out");
    if (protocol.practice == 0)
      place.refuse(node, "'feedback' is given in practice, and there is none; expected 'practice' above 0");
  }
  double trials = 0.0;
  for (std::size_t tissue = 0; tissue < protocol.tissues.size(); ++tissue)
    trials += static_cast<double>(pairs_of(protocol, tissue).size() * protocol.trials);
  if (protocol.design == Design::constant || (protocol.design == Design::magnitude && root.contains("scale")))
    trials *= static_cast<double>(protocol.scale.levels.size());
  if (trials > max_trials) {
    place.refuse(node_or_table(root, "trials"),
                 "all pairs and levels together are {:.0f} trials a subject, expected at most {:.0f}", trials,
                 max_trials);
  }
}

}  // namespace

Protocol parse_protocol(const std::string& text, const std::string& name,
                        const std::function<std::string(const std::string&)>& text_of,
                        std::shared_ptr<const SubjectTexts> kept) {
  const toml::table root = parse_toml(text, name);
  const Place place(name);
  place.allow_only(
      root, {"name",        "title",        "design",        "question",     "instructions",   "consent",
             "trials",      "practice",     "feedback",      "strategy",     "break",          "signal",
             "odd_one_out", "presentation", "interval",      "gap",          "longest",        "switching",
             "ramp",        "device",       "rate",          "loudness",     "sample",         "tissue",
             "scale",       "motion",       "limited_share", "trial",        "practice_until", "apparatus",
             "confidence",  "language",     "texts",         "catch",        "guide",          "standard",
             "modulus",     "points",       "ends",          "questionnaire"},
      "a protocol");
  Protocol protocol;
  protocol.toml = text;
  protocol.name = read_name(place, root, "a protocol");
  protocol.texts = read_texts(place, root, text_of, std::move(kept));
  protocol.title = read_plain_text(place, root, "title");
  if (protocol.title.empty()) protocol.title = (*protocol.texts)("title");
  protocol.design = read_design(place, root);
  protocol.instructions = read_plain_text(place, root, "instructions", true);
  protocol.consent = read_plain_text(place, root, "consent", true);
  read_trials(place, root, protocol);
  read_samples(place, root, text_of, protocol);
  read_catch_sample(place, root, protocol);
  read_tissues(place, root, protocol);
  read_signal(place, root, protocol);
  read_numbers(place, root, protocol);
  protocol.question = read_question(place, root, protocol);
  read_presentation(place, root, protocol);
  read_guide(place, root, protocol);
  read_rendering(place, root, protocol);
  read_scale(place, root, protocol);
  read_trial_rules(place, root, protocol);
  read_session_motion(place, root, protocol);
  protocol.apparatus = read_apparatus(place, root);
  protocol.questionnaire = read_questionnaire(place, root, *protocol.texts);
  require_sense(place, root, protocol);
  read_catch_trials(place, root, protocol);
  return protocol;
}

std::string text_named_by_protocol(const fs::path& file) {
  if (is_plugin(file.string())) return to_toml(law_of_plugin(file));
  if (file.extension() != ".h5") return read_named_file(file);
  return to_toml(table_of(schema::read_recording(file), file.string()).file);
}

Protocol read_protocol(const fs::path& file) {
  const fs::path folder = file.parent_path();
  const auto existing = [&](const fs::path& named) {
    fs::path found = folder / named;
    if (!fs::is_regular_file(found))
      throw std::invalid_argument(fmt::format("there is no file {}", found.string()));
    return found;
  };
  const auto text_of = [&](const std::string& named) { return text_named_by_protocol(existing(named)); };
  Protocol protocol = parse_protocol(read_named_file(file), file.string(), text_of);
  if (protocol.motion && !protocol.motion->scene.empty()) {
    try {
      protocol.motion->scene = existing(protocol.motion->scene);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("{}: [motion]: {}", file.string(), error.what()));
    }
  }
  return protocol;
}

}  // namespace kerf::bench
