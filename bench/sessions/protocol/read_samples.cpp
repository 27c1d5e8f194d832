#include <algorithm>
#include <stdexcept>

#include "laws/placement.h"
#include "protocol/protocol_parts.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_samples = 100;

const toml::array& array_of_tables(const Place& place, const toml::node& node, std::string_view key) {
  const toml::array* all = node.as_array();
  if (all == nullptr || all->empty() || !all->is_homogeneous<toml::table>())
    place.refuse(node, "expected one [[{}]] or more", key);
  return *all;
}

/// "N over rad on theta"; what two samples that are compared must have in common.
std::string axes_in_words(const LawFile& law) {
  std::string words;
  for (const models::LawAxis& axis : axes_of(law)) {
    words += fmt::format("{}{} over {} on {}", words.empty() ? "" : ", ", axis.force_unit, axis.position_unit,
                         !law.law.is_spatial() && law.axis.empty() ? "no axis by name" : axis.name);
  }
  return words;
}

void require_same_axes(const Place& place, const toml::node& node, const Protocol& protocol,
                       const SessionTissue& tissue) {
  const SessionSample& first = protocol.samples[tissue.samples.front()];
  std::vector<std::size_t> all = tissue.samples;
  if (protocol.catches.sample) all.push_back(*protocol.catches.sample);
  for (const std::size_t index : all) {
    const SessionSample& other = protocol.samples[index];
    if (axes_in_words(other.law) == axes_in_words(first.law)) continue;
    place.refuse(node,
                 "samples '{}' and '{}' cannot be compared: one gives {}, the other {}; their laws must have "
                 "the same 'axis' and units",
                 first.name, other.name, axes_in_words(first.law), axes_in_words(other.law));
  }
}

/// As many samples as the design compares.
void require_enough(const Place& place, const toml::node& node, bool of_levels, std::size_t samples,
                    std::string_view where) {
  if (of_levels && samples != 1) {
    place.refuse(node, "{} has {} samples; a design of levels has one, which it compares with itself", where,
                 samples);
  }
  if (!of_levels && samples < 2)
    place.refuse(node, "{} has one sample; expected two or more, to be compared", where);
}

SessionSample read_sample(const Place& place, const toml::table& table,
                          const std::function<std::string(const std::string&)>& law_text) {
  place.allow_only(table, {"name", "law", "recording"}, "a [[sample]]");
  const std::string name = read_name(place, table, "a [[sample]]");
  const bool is_recording = table.contains("recording");
  if (is_recording == table.contains("law")) {
    place.refuse(
        table,
        "sample '{}' needs a 'law', such as law = \"liver.law.toml\", or a 'recording', whose forces are "
        "looked up",
        name);
  }
  const std::string_view key = is_recording ? "recording" : "law";
  const std::string law = read_plain_text(place, table, key);
  try {
    const std::string text = law_text(law);
    return {.name = name, .law_name = law, .law_toml = text, .law = parse_law_file(text, law)};
  } catch (const std::invalid_argument& error) {
    place.refuse(*table.get(key), "{}", error.what());
  }
}

SessionTissue read_tissue(const Place& place, const toml::table& table, const Protocol& protocol,
                          bool of_levels) {
  place.allow_only(table, {"name", "samples"}, "a [[tissue]]");
  SessionTissue tissue{.name = read_name(place, table, "a [[tissue]]"), .samples = {}};
  for (const SessionTissue& other : protocol.tissues) {
    if (other.name == tissue.name)
      place.refuse(*table.get("name"), "there are two tissues named '{}'", tissue.name);
  }
  const toml::array* names = table.get_as<toml::array>("samples");
  if (names == nullptr) {
    place.refuse(node_or_table(table, "samples"),
                 "tissue '{}' needs 'samples', such as samples = [\"recording\", \"model\"]", tissue.name);
  }
  for (const toml::node& node : *names) {
    const std::size_t sample = sample_of(place, node, protocol);
    if (std::ranges::count(tissue.samples, sample) != 0)
      place.refuse(node, "tissue '{}' has sample '{}' twice", tissue.name, protocol.samples[sample].name);
    if (sample == protocol.catches.sample)
      place.refuse(node, "sample '{}' is that of [catch], so it can be in no tissue",
                   protocol.samples[sample].name);
    tissue.samples.push_back(sample);
  }
  require_enough(place, *names, of_levels, tissue.samples.size(), fmt::format("tissue '{}'", tissue.name));
  require_same_axes(place, *names, protocol, tissue);
  return tissue;
}

}  // namespace

std::size_t sample_of(const Place& place, const toml::node& node, const Protocol& protocol) {
  if (!node.is_string()) place.refuse(node, "a sample must be named by a text in quotes");
  const std::string name = **node.as_string();
  std::string known;
  for (std::size_t i = 0; i < protocol.samples.size(); ++i) {
    if (protocol.samples[i].name == name) return i;
    known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", protocol.samples[i].name);
  }
  place.refuse(node, "there is no sample {:?}; the samples are {}", name, known);
}

void read_samples(const Place& place, const toml::table& root,
                  const std::function<std::string(const std::string&)>& law_text, Protocol& protocol) {
  if (!root.contains("sample")) place.refuse(root, "a protocol needs its samples, one [[sample]] each");
  const toml::array& all = array_of_tables(place, *root.get("sample"), "sample");
  if (all.size() > max_samples)
    place.refuse(all, "there are {} samples, expected at most {}", all.size(), max_samples);
  for (const toml::node& node : all) {
    SessionSample sample = read_sample(place, *node.as_table(), law_text);
    for (const SessionSample& other : protocol.samples) {
      if (other.name == sample.name)
        place.refuse(*node.as_table()->get("name"), "there are two samples named '{}'", sample.name);
    }
    protocol.samples.push_back(std::move(sample));
  }
}

void read_tissues(const Place& place, const toml::table& root, Protocol& protocol) {
  const bool of_levels =
      has_levels(protocol.design) || (protocol.design == Design::magnitude && root.contains("scale"));
  if (const toml::node* tissues = root.get("tissue")) {
    const toml::array& all = array_of_tables(place, *tissues, "tissue");
    if (of_levels && all.size() > 1)
      place.refuse(all[1], "there are {} tissues; a design of levels has one", all.size());
    for (const toml::node& node : all)
      protocol.tissues.push_back(read_tissue(place, *node.as_table(), protocol, of_levels));
  } else {
    SessionTissue all{.name = "", .samples = {}};
    for (std::size_t i = 0; i < protocol.samples.size(); ++i) {
      if (i != protocol.catches.sample) all.samples.push_back(i);
    }
    require_enough(place, *root.get("sample"), of_levels, all.samples.size(), "the protocol");
    require_same_axes(place, *root.get("sample"), protocol, all);
    protocol.tissues.push_back(std::move(all));
  }
  for (std::size_t i = 0; i < protocol.samples.size(); ++i) {
    if (i == protocol.catches.sample) continue;
    const bool is_used = std::ranges::any_of(protocol.tissues, [&](const SessionTissue& tissue) {
      return std::ranges::count(tissue.samples, i) != 0;
    });
    if (!is_used) {
      place.refuse((*root.get_as<toml::array>("sample"))[i], "sample '{}' is in no [[tissue]]",
                   protocol.samples[i].name);
    }
  }
}

void read_signal(const Place& place, const toml::table& root, Protocol& protocol) {
  const Design design = protocol.design;
  protocol.odd_one_out = place.flag(root, "odd_one_out", false);
  if (root.contains("odd_one_out") && design != Design::three_interval)
    place.refuse(*root.get("odd_one_out"), "'odd_one_out' is for the design \"3ifc\", and this is \"{}\"",
                 name_of(design));
  const toml::node* signal = root.get("signal");
  if (design != Design::two_interval && design != Design::three_interval && design != Design::yes_no) {
    if (signal != nullptr) {
      place.refuse(*signal,
                   "'signal' is for the designs \"2ifc\", \"3ifc\" and \"yes-no\", and this is \"{}\"",
                   name_of(design));
    }
    return;
  }
  if (protocol.odd_one_out) {
    if (signal != nullptr)
      place.refuse(*signal, "with 'odd_one_out' either sample may be the odd one; leave 'signal' out");
    return;
  }
  if (signal == nullptr) {
    place.refuse(root, "the design \"{}\" needs 'signal', the sample that the question asks for{}",
                 name_of(design), design == Design::three_interval ? ", or odd_one_out = true" : "");
  }
  protocol.signal = sample_of(place, *signal, protocol);
  for (const SessionTissue& tissue : protocol.tissues) {
    if (std::ranges::count(tissue.samples, *protocol.signal) != 0) continue;
    place.refuse(*signal, "tissue '{}' is without the signal '{}'", tissue.name,
                 protocol.samples[*protocol.signal].name);
  }
}

}  // namespace kerf::bench
