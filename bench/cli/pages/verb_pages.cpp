#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <kerf/drivers/device.h>
#include <kerf/models/law.h>

#include "files/whole_file.h"
#include "files/whole_folder.h"
#include "pages/completion.h"
#include "pages/man_page.h"
#include "program/described.h"
#include "program/verbs.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

struct PagesArguments {
  std::string output;
  std::string date;
  bool force = false;
};

CompletionWords completion_words() {
  CompletionWords words;
  for (const models::LawInfo& law : models::registry()) words.laws.emplace_back(law.name);
  for (const drivers::DeviceInfo& device : drivers::list_devices()) words.devices.push_back(device.uri);
  return words;
}

void write_under(const fs::path& folder, const std::string& name, const std::string& text) {
  fs::create_directories(folder);
  write_whole_file(folder / name, text);
}

void run_pages(const CLI::App& program, const PagesArguments& arguments, Context& context) {
  const auto all = describe(program);
  const CompletionWords words = completion_words();
  WholeFolder whole(arguments.output, schema::existing_if(arguments.force));
  for (const DescribedVerb& verb : all)
    write_under(whole.path() / "man1", page_name(verb) + ".1", man_page(verb, all, arguments.date));
  write_under(whole.path() / "bash", "kerf", bash_completion(all, words));
  write_under(whole.path() / "zsh", "_kerf", zsh_completion(all, words));
  write_under(whole.path() / "fish", "kerf.fish", fish_completion(all, words));
  whole.commit();
  context.result = {{"folder", arguments.output}, {"pages", all.size()}};
  context.say(fmt::format("{} man pages and three completions are in {}", all.size(), arguments.output));
}

}  // namespace

void add_pages(CLI::App& app, Context& context) {
  auto arguments = std::make_shared<PagesArguments>();
  Verb verb =
      add_verb(app, context, "pages", "Write the manual and the completions of shells, made of --help",
               "kerf pages -o pages\n\nThe build does so, for what is installed.",
               [arguments, &app, &context] { run_pages(app, *arguments, context); });
  verb.add_option("-o,--output", arguments->output, "Folder for man1, bash, zsh and fish").required();
  verb.add_option("--date", arguments->date, "Date of the pages, 2026-11-25");
  verb.add_flag("--force", arguments->force, "Replace earlier ones");
}

}  // namespace kerf::bench
