#include "hosts/by_library/host_build.h"

#include <stdexcept>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/models/foreign.h>

#include "hosts/by_library/host_texts.h"
#include "own_code/compiler.h"

namespace kerf::bench {

namespace fs = std::filesystem;

fs::path kerf_library() {
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    for (const char* const below : {KERF_LIBRARY_FOLDER, "lib", "libkerf"}) {
      if (fs::path library = folder / below / "libkerf.so.1"; fs::exists(library)) return library;
    }
  }
  throw std::system_error(
      std::make_error_code(std::errc::no_such_file_or_directory),
      "libkerf.so.1 beside this program, which the exported source calls (Debian's package libkerf1)");
}

fs::path build_driver(const ScratchFolder& build, const fs::path& folder,
                      const std::vector<std::string>& options) {
  build.write("no_memory.h", host_text("no_memory.h.in"));
  fs::path program = build.path() / "driver";
  const fs::path source = build.path() / "driver.cpp";
  const fs::path library = kerf_library();
  std::vector<std::string> words = compiler_named("CXX", "c++");
  const std::string name = fmt::format("{}", fmt::join(words, " "));
  words.insert(words.end(), options.begin(), options.end());
  for (const fs::path& include :
       {build.path(), fs::absolute(folder), headers_with("kerf/kerf.h", "libkerf/include")}) {
    words.emplace_back("-I");
    words.push_back(include.string());
  }
  for (const std::string& word : {source.string(), std::string("-o"), program.string(), library.string(),
                                  fmt::format("-Wl,-rpath,{}", library.parent_path().string())})
    words.push_back(word);
  (void)compile(words, source, name);
  return program;
}

void write_chai3d_stubs(const ScratchFolder& build) { build.write("chai3d.h", host_text("chai3d.h.in")); }

void write_sofa_stubs(const ScratchFolder& build) {
  build.write("sofa_stubs.h", host_text("sofa_stubs.h.in"));
  for (const char* const header :
       {"sofa/version.h", "sofa/component/haptics/ForceFeedback.h", "sofa/core/ObjectFactory.h"})
    build.write(header, "#include \"sofa_stubs.h\"\n");
}

std::vector<std::string> plugin_argument(const ExportedLaw& law) {
  const models::ForeignLaw* const foreign = models::foreign_law(law.file.law.model());
  if (foreign == nullptr) return {};
  return {fs::absolute(foreign->plugin().path).string()};
}

std::string_view host_text(std::string_view name) {
  for (const EmbeddedFile& file : host_texts())
    if (file.name == name) return file.content;
  throw std::logic_error(fmt::format("no text of a host is named {}", name));
}

}  // namespace kerf::bench
