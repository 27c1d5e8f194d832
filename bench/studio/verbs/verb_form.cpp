#include "verbs/verb_form.h"

#include <array>
#include <string_view>

namespace kerf::bench {
namespace {

constexpr std::array<std::string_view, 9> value_kinds{"flag",   "number", "choice", "text",  "laws",
                                                      "device", "file",   "folder", "output"};

}  // namespace

nlohmann::ordered_json to_json(const VerbForm& form) {
  nlohmann::ordered_json json{{"verb", form.verb},
                              {"title", form.title},
                              {"group", form.group},
                              {"description", form.description},
                              {"more", form.more},
                              {"fixed", form.fixed},
                              {"values", nlohmann::ordered_json::array()}};
  for (const VerbValue& value : form.values) {
    json["values"].push_back({{"name", value.name},
                              {"label", value.label},
                              {"kind", value_kinds[static_cast<std::size_t>(value.kind)]},
                              {"words", value.words},
                              {"standard", value.standard},
                              {"required", value.required},
                              {"repeated", value.repeated}});
  }
  return json;
}

}  // namespace kerf::bench
