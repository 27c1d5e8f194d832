#include "files/json_file.h"

#include <kerf/version.h>

#include "files/for_terminal.h"
#include "files/whole_file.h"

namespace kerf::bench {

std::string json_text(nlohmann::ordered_json result) {
  result["software"] = software();
  return for_terminal(result.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) + "\n";
}

void write_json_file(const std::filesystem::path& file, const nlohmann::ordered_json& result,
                     schema::Existing existing) {
  write_whole_file(file, json_text(result), existing);
}

}  // namespace kerf::bench
