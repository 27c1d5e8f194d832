#include "files/json_file.h"
#include "files/whole_file.h"
#include "html/html.h"
#include "stability/findings.h"

namespace kerf::bench {

void refuse_to_replace_findings(const std::filesystem::path& folder, bool replace) {
  for (const auto* name : {"stability.json", "stability.csv", "stability.html"})
    require_output(folder / name, replace);
}

void write_findings(const Findings& findings, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const Figure& figure : findings.figures)
    write_whole_file(folder / (figure.name + ".svg"), draw(figure.chart) + "\n");
  write_whole_file(folder / "stability.csv", findings.csv);
  write_whole_file(folder / "stability.html",
                   html_page("Stability", "<h1>Where it breaks</h1>\n" + page_body(findings)));
  write_json_file(folder / "stability.json", findings.json);
}

}  // namespace kerf::bench
