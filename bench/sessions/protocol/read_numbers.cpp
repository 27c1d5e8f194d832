#include <algorithm>

#include "protocol/protocol_parts.h"

namespace kerf::bench {
namespace {

void refuse_foreign_number_keys(const Place& place, const toml::table& root, Design design) {
  for (const std::string_view key : {"standard", "modulus"}) {
    if (root.contains(key) && design != Design::magnitude)
      place.refuse(*root.get(key), "'{}' is for the design \"magnitude\", and this is \"{}\"", key,
                   name_of(design));
  }
  for (const std::string_view key : {"points", "ends"}) {
    if (root.contains(key) && design != Design::rating)
      place.refuse(*root.get(key), "'{}' is for the design \"rating\", and this is \"{}\"", key,
                   name_of(design));
  }
}

void read_modulus(const Place& place, const toml::table& root, Protocol& protocol) {
  const toml::node* standard = root.get("standard");
  const toml::node* modulus = root.get("modulus");
  if (standard == nullptr && modulus == nullptr) return;
  if (standard == nullptr)
    place.refuse(*modulus,
                 "'modulus' is the number of a standard; name the sample in 'standard', or leave it out");
  if (modulus == nullptr)
    place.refuse(*standard, "the 'standard' needs its number, such as modulus = 10; or leave it out");
  protocol.numbers.standard = sample_of(place, *standard, protocol);
  for (const SessionTissue& tissue : protocol.tissues) {
    if (std::ranges::count(tissue.samples, *protocol.numbers.standard) == 0)
      place.refuse(*standard, "tissue '{}' is without the standard '{}'", tissue.name,
                   protocol.samples[*protocol.numbers.standard].name);
  }
  protocol.numbers.modulus = read_plain_number(place, root, {.key = "modulus", .lower = 1e-3, .upper = 1e6});
}

void read_ends(const Place& place, const toml::table& root, Protocol& protocol) {
  const toml::node* node = root.get("ends");
  if (node == nullptr)
    place.refuse(root,
                 "the design \"rating\" needs 'ends', the words at its ends, such as ends = [\"not at all\", "
                 "\"very\"]");
  const toml::array* words = node->as_array();
  if (words == nullptr || words->size() != 2 || !words->is_homogeneous<std::string>())
    place.refuse(*node, "'ends' must be an array of two texts, such as [\"not at all\", \"very\"]");
  for (std::size_t end = 0; end < 2; ++end) {
    // As a table of its own, so that the same is asked of it as of every text.
    const toml::table one{{"ends", (*words)[end].value_or(std::string())}};
    const std::string word = read_plain_text(place, one, "ends");
    if (word.empty() || word.size() > 40)
      place.refuse((*words)[end], "'{}' is no word for an end; expected 1 to 40 characters", word);
    protocol.numbers.ends[end] = word;
  }
  if (protocol.numbers.ends[0] == protocol.numbers.ends[1])
    place.refuse(*node, "both ends are '{}'", protocol.numbers.ends[0]);
}

}  // namespace

void read_numbers(const Place& place, const toml::table& root, Protocol& protocol) {
  refuse_foreign_number_keys(place, root, protocol.design);
  if (protocol.design == Design::magnitude) read_modulus(place, root, protocol);
  if (protocol.design != Design::rating) return;
  read_ends(place, root, protocol);
  // A key a step.
  if (root.contains("points"))
    protocol.numbers.points = read_count(place, root, {.key = "points", .lower = 3.0, .upper = 9.0});
}

}  // namespace kerf::bench
