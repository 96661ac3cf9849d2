// main.cpp  sinew-rods: scenes of rods without a window, as pictures and a line of figures each.
#include <cstdio>
#include <filesystem>

#include "baker/common/bad_input.hpp"
#include "baker/common/command_line/within.hpp"
#include "baker/common/files/write_file.hpp"
#include "samples/rods/run_scene.hpp"
#include "samples/rods/scenes.hpp"
#include "samples/rods/sheet.hpp"

namespace {

using namespace sinew;

struct Request {
  std::string folder;
  std::vector<std::string> scenes;
  double seconds = 0;
  sample::PictureSize size;
};

struct NamedScene {
  const char* name;
  double seconds;
  sample::Story (*run)(double seconds);
};

constexpr NamedScene kScenes[] = {
    {"tree", 8, sample::tree_in_wind},
    {"helix", 3, sample::helix_on_plane},
    {"two_rods", 4, sample::two_rods},
#ifdef SINEW_HAS_BULLET
    {"drum", 10, sample::drum},
#endif
};

const NamedScene& find_scene(const std::string& name) {
  std::string known;
  for (const NamedScene& scene : kScenes) {
    if (scene.name == name) return scene;
    known += (known.empty() ? "" : ", ") + std::string(scene.name);
  }
  throw baker::BadInput("no scene '" + name + "'; there are " + known);
}

int run(Request request) {
  if (request.scenes.empty()) {
    for (const NamedScene& scene : kScenes) request.scenes.push_back(scene.name);
  }
  for (const std::string& name : request.scenes) find_scene(name);
  baker::make_folder(request.folder);
  for (const std::string& name : request.scenes) {
    const NamedScene& scene = find_scene(name);
    const sample::Story story = scene.run(request.seconds > 0 ? request.seconds : scene.seconds);
    const std::string path = std::filesystem::path(request.folder) / (name + ".png");
    std::printf("%s\n", sample::report_line(story).c_str());
    render::write_png(path, sample::sheet(story, request.size));
    std::printf("%s\n", path.c_str());
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("Scenes of rods as pictures, with what they cost.");
  app.add_option("-o,--output", request.folder, "folder of the pictures")->required();
  app.add_option("--scene", request.scenes, "only these; without: all");
  app.add_option("--seconds", request.seconds, "simulated; without: as long as each scene lasts")
      ->check(baker::within(0.1, 600, "0.1 to 600 s"));
  app.add_option("--width", request.size.width, "of each moment, pixels")->check(CLI::Range(16, 8192));
  app.add_option("--height", request.size.height, "of each moment, pixels")->check(CLI::Range(16, 8192));
  app.add_option("--samples", request.size.samples, "a pixel")->check(CLI::Range(1, 4096));
  app.add_option("--threads", request.size.threads, "that render; 0: all")->check(CLI::Range(0, 256));
  try {
    app.parse(argc, argv);
    return run(request);
  } catch (const CLI::CallForHelp& help) {
    return app.exit(help);
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "sinew-rods: %s\n", problem.what());
    return 2;
  }
}
