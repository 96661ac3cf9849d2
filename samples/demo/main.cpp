// main.cpp  sinew-demo: characters in a frame loop without a window; see README.md.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>

#include "baker/common/bad_input.hpp"
#include "baker/common/files/write_file.hpp"
#include "samples/demo/options.hpp"
#include "samples/demo/pictures.hpp"
#include "samples/demo/summary.hpp"

namespace {

using namespace sinew;
using namespace sinew::demo;

// What was not asked for follows from the truth, or is the usual.
Options completed(Options options, const Trajectory* truth) {
  if (options.fps == 0) options.fps = truth != nullptr ? truth->rate_hz() : 60;
  if (options.seconds == 0) options.seconds = truth != nullptr ? truth->seconds() : 4;
  if (truth != nullptr && options.seconds > truth->seconds()) {
    std::fprintf(stderr, "sinew-demo: %s lasts %.2f s; playing that\n", options.truth.c_str(),
                 truth->seconds());
    options.seconds = truth->seconds();
  }
  return options;
}

struct Names {
  std::string first, other;
};

// Of the files; with their folders where the files are called alike.
Names names_of(const std::string& first, const std::string& other) {
  using std::filesystem::path;
  Names names{path(first).stem(), path(other).stem()};
  if (names.first != names.other) return names;
  const auto with_folder = [](const path& file) {
    return (std::filesystem::absolute(file).parent_path().filename() / file.stem()).string();
  };
  return {with_folder(first), with_folder(other)};
}

CharacterFile open_beside(const CharacterFile& first, const std::string& path) {
  CharacterFile other = open_character(path);
  const std::string trouble = difference(first, other);
  if (!trouble.empty())
    throw baker::BadInput(path + ": is not the character of " + first.path + ": " + trouble +
                          "; bake both from one file");
  return other;
}

// The second pack under the first one's motion.
Run simulate_beside(const CharacterFile& other, const Motion& motion, Options options) {
  options.trace.clear();
  return simulate(other, motion, nullptr, options);
}

void run(const Options& asked) {
  const CharacterFile character = open_character(asked.pack);
  const auto beside = asked.compare.empty()
                          ? nullptr
                          : std::make_unique<CharacterFile>(open_beside(character, asked.compare));
  const std::unique_ptr<Motion> motion = make_motion(character, asked.clip);
  const auto truth = asked.truth.empty() ? nullptr : std::make_unique<Trajectory>(asked.truth, character);
  const Options options = completed(asked, truth.get());
  if (!options.frames.empty()) baker::make_folder(options.frames);
  const Names names = names_of(options.pack, options.compare);
  Run result = simulate(character, *motion, truth.get(), options);
  result.name = names.first;
  std::optional<Run> second;
  if (beside) {
    second = simulate_beside(*beside, *motion, options);
    second->name = names.other;
  }
  const Run* other = second ? &*second : nullptr;
  const Summary summary = summarise(result, character);
  print_table(summary, result, other, character, options);
  if (!options.report.empty()) write_report(options.report, summary, result, other, character, options);
  if (!options.frames.empty()) make_pictures(result, other, character, options);
}

int refuse(std::string message) {
  for (char& c : message) c = c == '\n' ? ' ' : c;
  std::fprintf(stderr, "sinew-demo: %s\n", message.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    if (parse_options(argc, argv, &options)) run(options);
    return 0;
  } catch (const std::bad_alloc&) {
    return refuse("out of memory; ask for fewer --instances, --seconds or pictures");
  } catch (const std::exception& problem) {
    return refuse(problem.what());
  }
}
